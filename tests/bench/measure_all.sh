#!/bin/bash
# Every figure of README's "How fast", by one command: wants an idle machine, the program's benchmarks built
# (cmake --preset release -DDELVOX_BUILD_BENCHMARKS=ON && cmake --build --preset release), Debian's libcgal-demo, the
# scans in DELVOX_SCANS (default ../shared/data) and 9 GB of disk, which it gives back.
#   tests/bench/measure_all.sh [--quick]
# --quick: liver only, up to 300 k tets, one run each, no stack: to see that all of it works.
# Leaves build/figures/ (compare_mesh3.csv, all that was printed in log.txt) and draws testdata/gallery/times.svg anew
# (--quick: build/figures/times.svg).
set -euo pipefail
cd "$(dirname "$0")/../.."
quick=false
case "${1:-}" in
  "") ;;
  --quick) quick=true ;;
  *) echo "usage: tests/bench/measure_all.sh [--quick]" >&2; exit 2 ;;
esac

scans=${DELVOX_SCANS:-$PWD/../shared/data}
bench=$PWD/build/release/tests/bench
delvox=$PWD/build/release/tools/delvox
figures=$PWD/build/figures
rm -rf "$figures"
mkdir -p "$figures"
exec > >(tee "$figures/log.txt") 2>&1
tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz -C "$figures" --strip-components=2 \
  data/images/liver.inr.gz data/images/skull_2.9.inr
nproc; grep -m1 'model name' /proc/cpuinfo; cat /proc/loadavg

liver="$figures/liver.inr.gz --iso 64 --smooth 0.8"
skull="$figures/skull_2.9.inr --iso 2.9"
brain="$scans/spm152.nii.gz --iso 40"
iguana="$scans/Iguana.nii.gz --iso 119.3"
repeat=$($quick && echo 1 || echo 3)

# compare INPUT SIZE: all contenders on one thread, then ours on two; both by turns, too.
compare() {
  local common="$1 --size $2 --repeat $repeat --csv $figures/compare_mesh3.csv"
  "$bench/compare_mesh3" $common
  "$bench/compare_mesh3" $common --only ours --threads 2
  if ! $quick; then by_turns "$1" $2; fi
}

# by_turns INPUT SIZE: ours on one thread and on two by turns, as what else the host does changes from minute to minute.
by_turns() {
  local turn threads
  for turn in 1 2 3 4 5 6 7; do
    for threads in 1 2; do
      "$bench/compare_mesh3" $1 --size $2 --only ours --repeat 1 --threads $threads \
        --csv "$figures/turns.csv" > /dev/null
    done
  done
  python3 - "$figures/turns.csv" "$1, size $2" <<'END'
import csv, statistics, sys
rows = list(csv.DictReader(open(sys.argv[1])))[-14:]
one, two = (statistics.median(float(row["seconds"]) for row in rows if row["threads"] == n) for n in "12")
print(f"{sys.argv[2]}: {one:.3f} s by one thread, {two:.3f} s by two: {one / two:.2f}; medians of 7 by turns")
END
}

# whole INPUT SIZE: the program from the file to the verified mesh in a VTU file, on one thread.
whole() {
  python3 - "$delvox" tet $1 --size $2 --threads 1 --min-dihedral 0 --quiet -o "$figures/whole.vtu" <<'END'
import statistics, subprocess, sys, time
def seconds():
    begin = time.monotonic()
    subprocess.run(sys.argv[1:], check=True)
    return time.monotonic() - begin
print(f"{' '.join(sys.argv[2:])}: {statistics.median(seconds() for _ in range(5)):.2f} s, median of 5")
END
}

for size in 10.2 5.45 2.953; do compare "$liver" $size; done
if ! $quick; then
  for size in 1.965 0.998; do compare "$liver" $size; done
  for size in 2.638 1.764; do compare "$skull" $size; done
  for size in 2.924 1.919; do compare "$brain" $size; done
  compare "$iguana" 0.12
  for size in 2.238 1.403; do compare "$scans/CT_pitch.nii.gz --iso 127.3" $size; done
  for size in 0.9335 0.6227; do compare "$scans/CT_AVM.nii.gz --iso 180" $size; done
  for run in "$liver --size 1.965" "$skull --size 1.764" "$brain --size 1.919" "$iguana --size 0.12"; do
    whole "${run% --size*}" "${run##*--size }"
    "$bench/memory_bench" $run
    "$bench/delaunay_bench" $run --repeat $repeat
  done
  for input in "$liver" "$brain" "$iguana"; do "$bench/oracle_bench" $input; done
  stack=$(mktemp -d "$figures/stack.XXXXXX")
  trap 'rm -rf "$stack"' EXIT
  "$delvox" phantom sphere --dims 2048,2048,1024 --type uint16 -o "$stack/stack.tif" --quiet
  "$bench/streaming_bench" "$stack/stack.tif" --iso 32767.5
fi
plot=$($quick && echo "$figures/times.svg" || echo testdata/gallery/times.svg)
tests/bench/plot_times.py "$figures/compare_mesh3.csv" liver.inr.gz "$plot"
echo "figures in $figures, plot in $plot"
