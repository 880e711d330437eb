#include "report_json.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <thread>

#include "core/output_file.h"
#include "thread_limit.h"

namespace delvox::tools {
namespace {

template <class T>
Json optional_json(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

// A flag's text as the JSON value it spells.
Json scalar_json(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || error != std::errc() || stop != end) return text;
  if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

Json option_json(const CLI::Option& option) {
  const bool is_flag = option.get_expected_max() == 0;
  const CLI::results_t& given = option.results();
  if (given.size() > 1 || (given.size() == 1 && option.get_expected_max() > 1)) return Json(given);
  if (given.size() == 1) return scalar_json(given[0]);
  if (is_flag) return false;
  const std::string text = option.get_default_str();
  return text.empty() ? Json(nullptr) : scalar_json(text);
}

Json to_json(const Promises& promises) {
  return {{"min_angle_degrees", optional_json(promises.min_angle_degrees)},
          {"radius_edge", optional_json(promises.radius_edge)},
          {"size_mm", optional_json(promises.size)},
          {"cell_size_mm", optional_json(promises.cell_size)},
          {"grade", optional_json(promises.grade)},
          {"max_deviation_mm", optional_json(promises.max_deviation)},
          {"max_roughness_degrees", optional_json(promises.max_roughness_degrees)},
          {"min_dihedral_degrees", optional_json(promises.min_dihedral_degrees)},
          {"feature_angle_degrees", optional_json(promises.feature_angle_degrees)}};
}

Json to_json(const Check& check) {
  Json json{{"name", check.name},         {"status", to_string(check.status)},  {"measured", check.measured},
            {"bound", optional_json(check.bound)}, {"unit", check.unit}, {"violations", check.violations}};
  json["where"] = check.where ? tools::to_json(*check.where) : Json(nullptr);
  if (!check.note.empty()) json["note"] = check.note;
  return json;
}

Json to_json(const Distribution& d) {
  return {{"count", d.count}, {"min", d.min},   {"max", d.max},  {"mean", d.mean},
          {"low", d.low},     {"high", d.high}, {"bins", d.bins}};
}

Json to_json(const ComponentStatistics& c) {
  return {{"triangles", c.triangles}, {"euler", c.euler},          {"genus", c.genus},
          {"volume_mm3", c.volume_mm3}, {"area_mm2", c.area_mm2}};
}

Json to_json(const SolverLimit& l) {
  return {{"solver", l.solver},
          {"measure", l.measure},
          {"severity", l.severity},
          {l.at_least ? "at_least" : "at_most", l.limit},
          {"tets", l.count},
          {"worst", l.worst},
          {"where", tools::to_json(l.where)}};
}

Json to_json(const MeshStatistics& s) {
  Json json{{"points", s.points},
            {"tets", s.tets},
            {"triangles", s.triangles},
            {"surface_components", s.surface_components},
            {"tet_components", s.tet_components},
            {"cavities", s.cavities},
            {"euler", s.euler},
            {"volume_mm3", s.volume_mm3},
            {"area_mm2", s.area_mm2}};
  json["components"] = Json::array();
  for (const ComponentStatistics& component : s.components) json["components"].push_back(to_json(component));
  if (s.angle_degrees.count > 0) json["angle_degrees"] = to_json(s.angle_degrees);
  if (s.dihedral_degrees.count > 0) json["dihedral_degrees"] = to_json(s.dihedral_degrees);
  if (s.radius_edge.count > 0) json["radius_edge"] = to_json(s.radius_edge);
  if (s.edge_mm.count > 0) json["edge_mm"] = to_json(s.edge_mm);
  if (s.face_angle_degrees.count > 0) json["face_angle_degrees"] = to_json(s.face_angle_degrees);
  if (s.aspect_ratio.count > 0) json["aspect_ratio"] = to_json(s.aspect_ratio);
  if (s.shape_factor.count > 0) json["shape_factor"] = to_json(s.shape_factor);
  if (s.jacobian_ratio.count > 0) json["jacobian_ratio"] = to_json(s.jacobian_ratio);
  return json;
}

Json to_json(const VoxelComparison& c) {
  return {{"voxel_surface_components", c.voxels.surface_components},
          {"voxel_inside_components", c.voxels.inside_components},
          {"voxel_cavities", c.voxels.cavities},
          {"voxel_euler", c.voxels.euler},
          {"voxel_volume_mm3", c.voxel_volume_mm3},
          {"volume_ratio", c.volume_ratio}};
}

void add_to(Json& json, const SurfaceDistances& d) {
  json.update({{"mesh_to_surface_max_mm", d.mesh_to_surface_max_mm},
               {"mesh_to_surface_mean_mm", d.mesh_to_surface_mean_mm},
               {"surface_to_mesh_max_mm", d.surface_to_mesh_max_mm},
               {"surface_to_mesh_mean_mm", d.surface_to_mesh_mean_mm}});
}

Json to_json(const FeatureComparison& c) {
  return {{"angle_degrees", c.angle_degrees},
          {"sharp_edges", c.sharp_edges},
          {"length_mm", c.length_mm},
          {"missing_mm", c.missing_mm},
          {"distance_mm", c.distance_mm},
          {"kept_edges", c.kept_edges},
          {"triangles", c.triangles},
          {"triangles_below_min_angle", c.below_min_angle},
          {"tets", c.tets},
          {"tets_above_radius_edge", c.above_radius_edge},
          {"tets_below_min_dihedral", c.below_min_dihedral}};
}

Json to_json(const Estimate& e) {
  return {{"vertices", std::round(e.vertices)},
          {"triangles", std::round(e.triangles)},
          {"tets", std::round(e.tets)},
          {"seconds", e.seconds},
          {"bytes", std::round(e.bytes)}};
}

}  // namespace

Json run_header(const Verb& verb, const Arguments& arguments) {
  Json command = Json::array({"delvox", verb.name});
  for (const std::string& argument : arguments) command.push_back(argument);
  return {{"delvox", DELVOX_VERSION},
          {"command", std::move(command)},
          {"hardware_threads", std::thread::hardware_concurrency()},
          {"threads", threads_in_use()}};
}

Json options_json(const CLI::App& app) {
  Json json = Json::object();
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_single_name();
    if (option->get_group().empty()) continue;  // not of this verb
    if (name != "help" && name != "version") json[name] = option_json(*option);
  }
  return json;
}

Json to_json(const Point3& p) { return Json::array({p.x, p.y, p.z}); }

Json to_json(const VolumeHeader& header) {
  Json affine = Json::array();
  for (const auto& row : header.index_to_world.rows) affine.push_back(row);
  return {{"format", header.format},
          {"sample_type", header.sample_type},
          {"dims", header.dims},
          {"spacing_mm", to_json(header.spacing())},
          {"orientation", header.orientation()},
          {"frame", to_string(header.frame)},
          {"index_to_world", std::move(affine)},
          {"warnings", header.warnings}};
}

Json to_json(const FilterReport& report) {
  return {{"kept", report.kept_components},
          {"removed", report.removed_components},
          {"removed_mm3", report.removed_mm3},
          {"cavities_filled", report.filled_cavities},
          {"filled_mm3", report.filled_mm3}};
}

Json to_json(const Forecast& forecast) {
  return {{"least", to_json(forecast.least)}, {"likely", to_json(forecast.likely)}, {"thin", forecast.thin()}};
}

Json to_json(const MeshInfo& info) {
  return {{"frame", to_string(info.frame)},
          {"isovalue", optional_json(info.isovalue)},
          {"below", info.below},
          {"open_border", info.open_border},
          {"complete", info.complete},
          {"unit", info.unit == LengthUnit::kMetre ? "m" : "mm"},
          {"promises", to_json(info.promises)}};
}

Json to_json(const RunReport& report) {
  Json unmet = Json::array();
  for (const Unmet& u : report.unmet) {
    unmet.push_back({{"criterion", u.criterion},
                     {"count", u.count},
                     {"where", u.where ? to_json(*u.where) : Json(nullptr)},
                     {"reason", u.reason},
                     {"breaks_promise", u.breaks_promise}});
  }
  return {{"stop", to_string(report.stop)},
          {"succeeded", report.succeeded()},
          {"unmet", std::move(unmet)},
          {"components", report.components},
          {"surface_insertions", report.surface_insertions},
          {"topology_insertions", report.topology_insertions},
          {"smooth_insertions", report.smooth_insertions},
          {"reinsertions", report.reinsertions},
          {"dense_insertions", report.dense_insertions},
          {"dense_failures", report.dense_failures},
          {"interior_insertions", report.interior_insertions},
          {"removals", report.removals}};
}

Json to_json(const SliverReport& report) {
  Json unmet = Json::array();
  for (const UnmetTet& tet : report.unmet) {
    unmet.push_back({{"where", to_json(tet.where)},
                     {"dihedral_degrees", tet.dihedral_degrees},
                     {"reason", tet.reason},
                     {"surface_forbids", tet.surface_forbids}});
  }
  return {{"slivers", report.slivers},
          {"reconnections", report.reconnections},
          {"moves", report.moves},
          {"insertions", report.insertions},
          {"removals", report.removals},
          {"unmet", std::move(unmet)}};
}

Json to_json(const CheckReport& report) {
  Json checks = Json::array();
  for (const Check& check : report.checks) checks.push_back(to_json(check));
  Json json{{"all_hold", report.all_hold()}, {"checks", std::move(checks)}, {"statistics", to_json(report.statistics)}};
  if (report.comparison) {
    json["comparison"] = to_json(*report.comparison);
    add_to(json["comparison"], report.comparison->distances);
  }
  if (report.surface_comparison) {
    json["surface_comparison"] = {{"surface_components", report.surface_comparison->components},
                                  {"surface_euler", report.surface_comparison->euler}};
    add_to(json["surface_comparison"], report.surface_comparison->distances);
  }
  if (report.feature_comparison) json["features"] = to_json(*report.feature_comparison);
  if (!report.solver_limits.empty()) {
    json["solver_limits"] = Json::array();
    for (const SolverLimit& limit : report.solver_limits) json["solver_limits"].push_back(to_json(limit));
  }
  return json;
}

Json to_json(const std::vector<StageTime>& stages) {
  Json json = Json::array();
  for (const StageTime& stage : stages) json.push_back({{"stage", stage.stage}, {"seconds", stage.seconds}});
  return json;
}

Json materials_json(const Mesh& mesh) {
  Json json = Json::array();
  if (const auto* tets = std::get_if<TetMesh>(&mesh)) {
    for (const Material& material : tets->materials) {
      json.push_back({{"name", material.name},
                      {"region", material.region},
                      {"youngs_modulus_mpa", material.youngs_modulus_mpa},
                      {"poisson_ratio", material.poisson_ratio},
                      {"density_kg_m3", material.density_kg_m3}});
    }
  }
  return json;
}

Json sets_json(const Mesh& mesh) {
  Json json = Json::array();
  if (const auto* tets = std::get_if<TetMesh>(&mesh)) {
    for (const MeshSet& set : tets->sets) {
      json.push_back(
          {{"name", set.name}, {"nodes", set.nodes.size()}, {"tets", set.tets.size()}, {"faces", set.faces.size()}});
    }
  }
  return json;
}

std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

void write_json(const Json& json, const std::string& path) {
  OutputFile file(path);
  file.stream() << text_of(json);
  file.commit();
}

}  // namespace delvox::tools
