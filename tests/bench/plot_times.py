#!/usr/bin/env python3
"""Draws the seconds of compare_mesh3's --csv file against its tets, as SVG: one line for each contender, both axes
logarithmic. Bulk insertion, which makes no mesh of its own, stands at the tets of the mesh whose vertices it inserts.

usage: plot_times.py FIGURES.csv VOLUME OUT.svg [--cpu]

--cpu: seconds of CPU, of runs on one thread, for figures from a machine that was not idle.
"""
import csv
import math
import sys

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 720, 460, 62, 190, 34, 48
# Contender and threads, what the legend calls them, colour, dashes.
SERIES = [
    (("CGAL sequential", 1), "CGAL, sequential tag", "#b03a2e", ""),
    (("CGAL parallel", 1), "CGAL, parallel tag, 1 thread", "#d68910", ""),
    (("delvox", 1), "delvox, 1 thread", "#1f618d", ""),
    (("delvox", 2), "delvox, 2 threads", "#17a589", ""),
    (("bulk insertion", 1), "limit: bulk insertion", "#777777", "6 4"),
]


def read_points(path, volume, cpu):
    """(contender, threads) -> ascending [(tets, seconds)]."""
    column = "cpu_seconds" if cpu else "seconds"
    with open(path, newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["volume"] == volume]
    if cpu:
        rows = [row for row in rows if row["threads"] == "1"]
    if not rows:
        sys.exit(f"{path}: has no line for {volume}")
    tets_at = {row["size"]: int(row["tets"]) for row in rows if row["contender"] == "delvox"}
    points = {}
    for row in rows:
        tets = tets_at.get(row["size"], 0) if row["contender"] == "bulk insertion" else int(row["tets"])
        if tets > 0:
            points.setdefault((row["contender"], int(row["threads"])), []).append((tets, float(row[column])))
    return {key: sorted(values) for key, values in points.items()}


def decades(low, high):
    """Ticks 1, 2, 5 times powers of ten within [low, high]."""
    ticks = [m * 10.0**e for e in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1) for m in (1, 2, 5)]
    return [t for t in ticks if low <= t <= high]


def short(number):
    for limit, unit in ((1e6, " M"), (1e3, " k")):
        if number >= limit:
            return f"{number / limit:g}{unit}"
    return f"{number:g}"


class Axis:
    def __init__(self, values, start, end):
        self.low, self.high = min(values) / 1.3, max(values) * 1.3
        self.start, self.end = start, end

    def at(self, value):
        part = math.log(value / self.low) / math.log(self.high / self.low)
        return self.start + part * (self.end - self.start)

    def ticks(self):
        return decades(self.low, self.high)


def text(x, y, content, anchor="middle", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {more}>{content}</text>'


def draw(points, volume, unit):
    everything = [p for values in points.values() for p in values]
    x = Axis([p[0] for p in everything], LEFT, WIDTH - RIGHT)
    y = Axis([p[1] for p in everything], HEIGHT - BOTTOM, TOP)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
           f'font-size="12" fill="#222">', f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
           text((LEFT + WIDTH - RIGHT) / 2, 20, f"From the volume in memory to the mesh: {volume}")]
    for tick in x.ticks():
        out.append(f'<path d="M{x.at(tick):.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>')
        out.append(text(x.at(tick), HEIGHT - BOTTOM + 18, short(tick)))
    for tick in y.ticks():
        out.append(f'<path d="M{LEFT} {y.at(tick):.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
        out.append(text(LEFT - 8, y.at(tick) + 4, short(tick), "end"))
    out.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, "tets"))
    out.append(text(16, HEIGHT / 2, unit, more=f'transform="rotate(-90 16 {HEIGHT / 2:.0f})"'))
    row = 0
    for key, name, colour, dashes in SERIES:
        if key not in points:
            continue
        places = [(x.at(tets), y.at(seconds)) for tets, seconds in points[key]]
        path = "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in places)
        style = f'stroke="{colour}" stroke-width="2" fill="none" stroke-dasharray="{dashes}"'
        out.append(f'<path d="{path}" {style}/>')
        out += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3" fill="{colour}"/>' for a, b in places]
        height = TOP + 14 + 20 * row
        out.append(f'<path d="M{WIDTH - RIGHT + 12} {height - 4}h22" {style}/>')
        out.append(text(WIDTH - RIGHT + 38, height, name, "start", 'font-size="10.5"'))
        row += 1
    return "\n".join(out + ["</svg>", ""])


def main():
    arguments = [a for a in sys.argv[1:] if a != "--cpu"]
    cpu = "--cpu" in sys.argv
    if len(arguments) != 3:
        sys.exit(__doc__)
    figures, volume, out = arguments
    svg = draw(read_points(figures, volume, cpu), volume, "seconds of CPU" if cpu else "seconds")
    with open(out, "w") as file:
        file.write(svg)


main()
