#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "delvox/check/check_mesh.h"
#include "delvox/core/mesh.h"
#include "delvox/core/run.h"
#include "delvox/meshing/forecast.h"
#include "delvox/meshing/remove_slivers.h"
#include "delvox/volume/volume.h"
#include "verbs.h"

namespace delvox::tools {

using Json = nlohmann::ordered_json;

/// Version, verb, command line, number of threads.
Json run_header(const Verb& verb, const Arguments& arguments);

/// Every option of a parsed app by its long name, with the value it has, given or default (null: no value).
Json options_json(const CLI::App& app);

Json to_json(const Point3& p);
Json to_json(const VolumeHeader& header);
Json to_json(const FilterReport& report);
Json to_json(const Forecast& forecast);
Json to_json(const MeshInfo& info);
Json to_json(const RunReport& report);
Json to_json(const SliverReport& report);
Json to_json(const CheckReport& report);
Json to_json(const std::vector<StageTime>& stages);

/// The materials of a mesh.
Json materials_json(const Mesh& mesh);
/// Name and extent of each set of a mesh.
Json sets_json(const Mesh& mesh);

/// JSON text, indented, with a line end; bytes that are not UTF-8 (in file names) are replaced.
std::string text_of(const Json& json);

/// Writes text_of(json) to a file. Throws IoError.
void write_json(const Json& json, const std::string& path);

}  // namespace delvox::tools
