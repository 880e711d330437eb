#include "scoreboard.h"

#include <algorithm>
#include <cstdio>
#include <functional>

namespace delvox::bench {

namespace {

constexpr double kMegabyte = 1024 * 1024;

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[160];
  std::snprintf(buffer, sizeof(buffer), format, values...);
  return buffer;
}

std::string count(std::size_t n) {
  std::string digits = std::to_string(n);
  for (int i = static_cast<int>(digits.size()) - 3; i > 0; i -= 3) digits.insert(static_cast<std::size_t>(i), " ");
  return digits;
}

std::vector<double> sorted_times(const Column& column, double Outcome::*time) {
  std::vector<double> times;
  for (const Outcome& run : column.runs) times.push_back(run.*time);
  std::sort(times.begin(), times.end());
  return times;
}

double median_time(const Column& column, double Outcome::*time) {
  const std::vector<double> times = sorted_times(column, time);
  return times[times.size() / 2];
}

bool succeeded(const Column& column) {
  return !column.runs.empty() &&
         std::all_of(column.runs.begin(), column.runs.end(), [](const Outcome& r) { return r.ok; });
}

double tets_of(const Column& column) {
  const Outcome& run = median_run(column);
  return static_cast<double>(column.bulk ? run.all_cells : run.mesh.tets);
}

double tets_per_second(const Column& column) {
  return tets_of(column) / median_time(column, &Outcome::seconds);
}
double tets_per_cpu_second(const Column& column) {
  return tets_of(column) / median_time(column, &Outcome::cpu_seconds);
}

const Column* find(const std::vector<Column>& columns, const std::string& name) {
  for (const Column& column : columns) {
    if (column.name == name && succeeded(column)) return &column;
  }
  return nullptr;
}

struct Line {
  const char* title;
  bool for_bulk;
  std::function<std::string(const Column&, const Outcome&)> cell;
};

std::vector<Line> lines(const Column* ours) {
  const auto ratio = [ours](double theirs, double mine) {
    return ours ? text("%.2f", theirs / mine) : std::string("-");
  };
  return {
      {"tets (bulk: all cells)", true,
       [](const Column& c, const Outcome& r) { return count(c.bulk ? r.all_cells : r.mesh.tets); }},
      {"vertices", true, [](const Column&, const Outcome& r) { return count(r.mesh.vertices); }},
      {"time, s (median)", true, [](const Column&, const Outcome& r) { return text("%.3f", r.seconds); }},
      {"time, s (min - max)", true,
       [](const Column& c, const Outcome&) {
         const std::vector<double> times = sorted_times(c, &Outcome::seconds);
         return text("%.3f - %.3f", times.front(), times.back());
       }},
      {"CPU time, s (median)", true,
       [](const Column& c, const Outcome&) { return text("%.3f", median_time(c, &Outcome::cpu_seconds)); }},
      {"tets per second", true,
       [](const Column& c, const Outcome&) { return count(static_cast<std::size_t>(tets_per_second(c))); }},
      {"tets per CPU second", true,
       [](const Column& c, const Outcome&) { return count(static_cast<std::size_t>(tets_per_cpu_second(c))); }},
      {"time / ours", true,
       [=](const Column& c, const Outcome&) {
         return ratio(median_time(c, &Outcome::seconds), ours ? median_time(*ours, &Outcome::seconds) : 1);
       }},
      {"tets per second: ours / this", true,
       [=](const Column& c, const Outcome&) { return ratio(ours ? tets_per_second(*ours) : 1, tets_per_second(c)); }},
      {"tets per CPU second: ours / this", true,
       [=](const Column& c, const Outcome&) {
         return ratio(ours ? tets_per_cpu_second(*ours) : 1, tets_per_cpu_second(c));
       }},
      {"peak memory, MB", true, [](const Column&, const Outcome& r) { return text("%.1f", r.peak_bytes / kMegabyte); }},
      {"bytes per tet", true,
       [](const Column& c, const Outcome& r) {
         return text("%.0f", r.peak_bytes / static_cast<double>(c.bulk ? r.all_cells : r.mesh.tets));
       }},
      {"smallest dihedral, deg", false,
       [](const Column&, const Outcome& r) { return text("%.3f", r.mesh.min_dihedral_degrees); }},
      {"tets with less than 15 deg", false, [](const Column&, const Outcome& r) { return count(r.mesh.slivers); }},
      {"smallest surface angle, deg", false,
       [](const Column&, const Outcome& r) { return text("%.3f", r.mesh.min_angle_degrees); }},
      {"largest radius-edge", false,
       [](const Column&, const Outcome& r) { return text("%.4f", r.mesh.max_radius_edge); }},
      {"largest circumradius, mm", false,
       [](const Column&, const Outcome& r) { return text("%.4f", r.mesh.max_circumradius); }},
      {"non-manifold boundary edges", false, [](const Column&, const Outcome& r) { return count(r.mesh.bad_edges); }},
      {"non-manifold boundary vertices", false,
       [](const Column&, const Outcome& r) { return count(r.mesh.bad_vertices); }},
      {"nodes off the isosurface, voxels: max", false,
       [](const Column&, const Outcome& r) { return text("%.3g", r.mesh.max_off_voxels); }},
      {"nodes off the isosurface, voxels: mean", false,
       [](const Column&, const Outcome& r) { return text("%.3g", r.mesh.mean_off_voxels); }},
      {"boundary triangles", false, [](const Column&, const Outcome& r) { return count(r.mesh.boundary_triangles); }},
      {"parts", false, [](const Column&, const Outcome& r) { return count(r.mesh.parts); }},
      {"volume, mm3", false, [](const Column&, const Outcome& r) { return text("%.6g", r.mesh.volume_mm3); }},
  };
}

}  // namespace

const Outcome& median_run(const Column& column) {
  std::vector<const Outcome*> order;
  for (const Outcome& run : column.runs) order.push_back(&run);
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  std::nth_element(order.begin(), middle, order.end(),
                   [](const Outcome* a, const Outcome* b) { return a->seconds < b->seconds; });
  return **middle;
}

std::string scoreboard(const std::vector<Column>& columns) {
  std::string table = text("| %-38s |", "");
  for (const Column& column : columns) table += text(" %18s |", column.name.c_str());
  table += "\n|" + std::string(40, '-') + "|";
  for (std::size_t i = 0; i < columns.size(); ++i) table += std::string(19, '-') + ":|";
  table += "\n";
  for (const Line& line : lines(find(columns, "delvox"))) {
    table += text("| %-38s |", line.title);
    for (const Column& column : columns) {
      const std::string cell = !succeeded(column)              ? "failed"
                               : column.bulk && !line.for_bulk ? ""
                                                               : line.cell(column, median_run(column));
      table += text(" %18s |", cell.c_str());
    }
    table += "\n";
  }
  return table;
}

std::string csv_names() {
  return "contender,runs,seconds,least_seconds,most_seconds,cpu_seconds,tets,vertices,all_cells,peak_bytes,"
         "bad_edges,min_dihedral_degrees,slivers";
}

std::string csv_rows(const std::vector<Column>& columns, const std::string& setting) {
  std::string rows;
  for (const Column& column : columns) {
    if (!succeeded(column)) continue;
    const std::vector<double> times = sorted_times(column, &Outcome::seconds);
    const Outcome& run = median_run(column);
    rows += setting + "," + column.name;
    rows += text(",%zu,%.4f,%.4f,%.4f,%.4f", times.size(), run.seconds, times.front(), times.back(),
                 median_time(column, &Outcome::cpu_seconds));
    rows += text(",%zu,%zu,%zu,%.0f,%zu,%.4f,%zu\n", run.mesh.tets, run.mesh.vertices, run.all_cells, run.peak_bytes,
                 run.mesh.bad_edges, run.mesh.min_dihedral_degrees, run.mesh.slivers);
  }
  return rows;
}

std::string verdict(const std::vector<Column>& columns) {
  const Column* ours = find(columns, "delvox");
  const Column* best = nullptr;
  for (const char* name : {"CGAL sequential", "CGAL parallel"}) {
    const Column* column = find(columns, name);
    if (column && (!best || tets_per_second(*column) > tets_per_second(*best))) best = column;
  }
  if (!ours || !best) return "";
  return text(
      "delvox makes %.2f times the tets per second of %s (%.2f per CPU second), with %.2f times its peak memory.\n",
      tets_per_second(*ours) / tets_per_second(*best), best->name.c_str(),
      tets_per_cpu_second(*ours) / tets_per_cpu_second(*best),
      median_run(*ours).peak_bytes / median_run(*best).peak_bytes);
}

}  // namespace delvox::bench
