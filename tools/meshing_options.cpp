#include "meshing_options.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "delvox/core/errors.h"
#include "delvox/mesh_io/read_mesh.h"
#include "formula_flags.h"
#include "delvox/mesh_io/read_samples.h"
#include "validators.h"

namespace delvox::tools {
namespace {

void add_size_options(CLI::App& app, MeshingOptions& options) {
  auto* size = app.add_option(
      "--size", options.size,
      "Upper bound on the radii of surface Delaunay balls, mm: a number; a volume file as size "
      "field; a formula in x, y, z; lfs or curvature: --epsilon times the local feature size "
      "or the radius of curvature (default: 1/60 of the diagonal of the box around what is meshed, of volumes "
      "at least 1.5 voxel, of samples at least their spacing; 1/40 of that of a formula's --box; of --algorithm "
      "delsurf1 lfs, of delsurf2 none)");
  size->type_name("S");
  app.add_option("--epsilon", options.epsilon,
                 "With --size lfs or curvature: the share of it, up to 1; up to 0.08 meshes are known to be right "
                 "(default: 0.08)")
      ->check(finite_number(Zero::kExcluded) & CLI::Range(0.0, 1.0))
      ->type_name("E");
  if (options.kind == MeshKind::kSurface) return;
  app.add_option("--tets", options.tets, "Find the size that gives about this many tets")
      ->check(CLI::Range(100.0, 1e9))
      ->excludes(size)
      ->type_name("N");
  app.add_option("--cell-size", options.cell_size,
                 "Upper bound on the circumradii of tets, mm: a number or a volume file (default: as --size; with "
                 "--grade: none but that)")
      ->type_name("S");
  app.add_option("--grade", options.grade,
                 "Tets grow with depth: circumradii up to --size + G * distance from the surface, G from 0 (off) to 1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str()
      ->type_name("G");
}

/// DelSurf2 takes all components of a surface without a border, and nothing foretells what that takes.
void check_algorithm(const CLI::App& app, const MeshingOptions& options) {
  if (options.algorithm != "delsurf2") return;
  for (const char* name : {"--largest", "--min-component", "--fill-cavities", "--border", "--start", "--restricted",
                           "--max-roughness"}) {
    if (app.count(name) > 0) throw OptionError(std::string(name) + ": not with --algorithm delsurf2");
  }
  if (!options.max_memory.empty()) {
    throw OptionError("--max-memory: what delsurf2 takes cannot be forecast; --max-vertices limits it");
  }
}

void add_shape_options(CLI::App& app, MeshingOptions& options) {
  app.add_option("--min-angle", options.min_angle_degrees, "Lower bound on the angles of surface triangles, 0 to 30")
      ->check(CLI::Range(0.0, 30.0))
      ->capture_default_str()
      ->type_name("DEG");
  if (options.kind == MeshKind::kTets) {
    app.add_option("--radius-edge", options.radius_edge, "Upper bound on circumradius / shortest edge of tets, from 2")
        ->check(CLI::Range(2.0, 1e6))
        ->capture_default_str()
        ->type_name("RATIO");
    app.add_option("--min-dihedral", options.min_dihedral_degrees,
                   "Lower bound on the dihedral angles of tets, up to 30; 0 leaves slivers as they are (default: 15, "
                   "and tets that cannot have it are no failure)")
        ->check(CLI::Range(0.0, 30.0))
        ->type_name("DEG");
  }
  app.add_option("--max-deviation", options.max_deviation,
                 "Upper bound on the distance from a triangle's circumcentre to its surface ball centre, mm")
      ->check(finite_number(Zero::kExcluded))
      ->type_name("MM");
  app.add_option("--max-roughness", options.max_roughness_degrees,
                 "Upper bound on the angle between neighbouring surface triangles, pi less their dihedral angle, up to "
                 "180. Where a surface is not smooth it cannot be had: that is counted and told")
      ->check(angle_above_zero(180))
      ->type_name("DEG");
  if (options.input != InputKind::kVolume) {
    app.add_option("--feature-angle", options.feature_angle_degrees,
                   "Keep the sharp edges of a polygon surface: those between two facets whose normals are more than "
                   "this apart (0: the facets lie in one plane; 90: the edges of a cube), above 0 and up to 180. They "
                   "become edges of the mesh, and their corners nodes. Triangles and tets with a node on them are held "
                   "to sizes, but not to the other bounds: they are counted apart (default: edges are not kept)")
        ->check(angle_above_zero(180))
        ->type_name("DEG");
  }
  app.add_option(
         "--min-ball-radius", options.min_ball_radius,
         "Topology, folds, deviation, roughness and --restricted all leave surface balls this small alone, mm (default: "
         "0.0001 voxel; for formulas, samples and polygon surfaces 0.001 size; for the last two 0.5 voxel, or 0.05 size)")
      ->check(finite_number(Zero::kAllowed))
      ->type_name("MM");
}

void add_algorithm_option(CLI::App& app, MeshingOptions& options) {
  std::vector<std::string> names{"delsurf", "delsurf1"};
  std::string text = "delsurf: a manifold whatever the size. delsurf1: looks at sizes only, for those at most 0.08 of the "
                     "local feature size";
  if (options.input == InputKind::kVolume) {
    names.push_back("delsurf2");
    text += ". delsurf2: as fine as the topology asks, and no finer unless --size says so, of smooth formulas and of "
            "volumes of up to 32 x 32 x 32 voxels, interpolated by a spline";
  }
  app.add_option("--algorithm", options.algorithm, text)
      ->check(CLI::IsMember(names))
      ->capture_default_str()
      ->type_name("NAME");
}

void add_dense_flag(CLI::App& app, MeshingOptions& options) {
  auto* dense = app.add_flag("--surface-only-after-dense", options.surface_only_after_dense,
                             "Once the sample is dense, refine the surface alone, without the triangulation of space: "
                             "with less memory; the same is promised and checked");
  if (options.kind == MeshKind::kTets) dense->group("");  // known, to say why not
}

/// What needs the triangulation of space to the end.
void check_dense(const CLI::App& app, const MeshingOptions& options) {
  if (!options.surface_only_after_dense) return;
  const auto refuse = [](const std::string& why) { throw OptionError("--surface-only-after-dense: " + why); };
  if (options.kind == MeshKind::kTets) {
    refuse("tets are the triangulation of space; it is for delvox surface and remesh");
  }
  if (options.algorithm != "delsurf") refuse("not with --algorithm " + options.algorithm);
  if (options.start != "seeds") refuse("not with --start " + options.start);
  if (options.restricted != "bipolar") refuse("not with --restricted " + options.restricted);
  for (const char* name : {"--max-roughness", "--feature-angle"}) {
    const CLI::Option* option = app.get_option_no_throw(name);
    if (option != nullptr && option->count() > 0) refuse(std::string("not with ") + name);
  }
}

void add_variant_options(CLI::App& app, MeshingOptions& options) {
  if (options.kind == MeshKind::kSurface) add_algorithm_option(app, options);
  auto* start = app.add_option("--start", options.start,
                               "What the sample begins with: seeds on all of the surface, or a persistent triangle on "
                               "each component, whose vertices but one are deleted in the end");
  start->check(CLI::IsMember({"seeds", "persistent"}))->capture_default_str()->type_name("HOW");
  app.add_option("--seed", options.seed, "Of the random choice of persistent triangles")
      ->needs(start)
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--restricted", options.restricted,
                 "Triangles whose dual Voronoi edges meet the surface: those with ends on both sides of it (bipolar; "
                 "others only where there would be none), or all")
      ->check(CLI::IsMember({"bipolar", "all"}))
      ->capture_default_str()
      ->type_name("WHICH");
  add_dense_flag(app, options);
}

void add_limit_options(CLI::App& app, MeshingOptions& options) {
  app.add_option("--max-vertices", options.limits.max_vertices, "Stop at this many vertices (0: no limit)")
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--max-seconds", options.limits.max_seconds, "Stop meshing after this time (0: no limit)")
      ->check(finite_number(Zero::kAllowed))
      ->capture_default_str()
      ->type_name("S");
  app.add_option("--max-memory", options.max_memory,
                 "Refuse to begin if the forecast for the whole process exceeds this: 4G, 800M (default: no limit)")
      ->type_name("SIZE");
}

/// What makes sense for isosurfaces only; of volumes; of samples.
constexpr const char* kOfIsosurfaces[] = {"--iso", "--below"};
constexpr const char* kOfVolumes[] = {"--border", "--spacing", "--volume-index", "--crop", "--resample", "--smooth",
                                      "--largest", "--min-component", "--fill-cavities", "--hu-density", "--modulus",
                                      "--material-bins", "--peel", "--poisson"};
constexpr const char* kOfSamples[] = {"--field", "--interpolation"};

/// Throws OptionError if one of `names` was given.
template <std::size_t N>
void refuse(const CLI::App& app, const char* const (&names)[N], const std::string& why) {
  for (const char* name : names) {
    const CLI::Option* option = app.get_option_no_throw(name);
    if (option != nullptr && option->count() > 0) throw OptionError(std::string(name) + ": " + why);
  }
}

/// Texts of columns, and .vtu files of which a field, an interpolation or an isovalue is asked for.
bool holds_samples(const CLI::App& app, const std::string& path) {
  if (is_samples_path(path)) return true;
  if (std::filesystem::path(path).extension() != ".vtu") return false;
  return app.count("--field") + app.count("--interpolation") + app.count("--iso") + app.count("--below") > 0;
}

void exclude_volume_options(CLI::App& app) {
  CLI::Option* implicit = app.get_option("--implicit");
  const char* input = app.get_option_no_throw("VOLUME") != nullptr ? "VOLUME" : "INPUT";
  implicit->excludes(app.get_option(input));
  const auto exclude = [&](const auto& names) {
    for (const char* name : names) {
      if (CLI::Option* option = app.get_option_no_throw(name)) implicit->excludes(option);
    }
  };
  exclude(kOfIsosurfaces);
  exclude(kOfVolumes);
  exclude(kOfSamples);
}

constexpr const char* kVolumes = ".nii .nii.gz .hdr .inr .inr.gz .tif .json .vdb, a folder of slices";
constexpr const char* kSamples = "scattered samples: .csv .tsv .txt with columns x, y, z and a value, .vtu with --field";
constexpr const char* kMeshes = ".stl .ply .off .obj .vtu .vtk .mesh .msh .inp .feb .bdf .nas .unv "
                                "(of tets: their boundary)";

void add_input(CLI::App& app, MeshingOptions& options) {
  std::string name = "VOLUME", text = std::string("The scan: ") + kVolumes + "; or " + kSamples;
  if (options.input == InputKind::kPolygons) {
    name = "SURFACE", text = std::string("A closed polygon surface: ") + kMeshes;
  } else if (options.input == InputKind::kEither) {
    name = "INPUT", text += std::string("; or a closed polygon surface: ") + kMeshes;
  }
  app.add_option(name, options.volume.path, text)->required(options.input == InputKind::kPolygons);
}

void add_volume_options(CLI::App& app, MeshingOptions& options) {
  add_isovalue_options(app, options.isosurface);
  if (options.kind == MeshKind::kSurface) {
    app.add_option("--border", options.border,
                   "Where the organ is cut by the image edge: close the surface there, or leave it open")
        ->check(CLI::IsMember({"close", "open"}))
        ->capture_default_str()
        ->type_name("HOW");
  }
  add_field_option(app, options.samples);
  add_interpolation_option(app, options.samples);
  add_reading_options(app, options.volume);
  add_preprocessing_options(app, options.volume);
  add_component_options(app, options.isosurface);
}

/// Sharp edges are those of polygons, and take the usual way of refinement.
void check_feature_angle(const MeshingOptions& options, bool polygons) {
  if (!options.feature_angle_degrees) return;
  if (!options.implicit.empty() || !polygons) {
    throw OptionError("--feature-angle: keeps sharp edges of polygon surfaces, and " +
                      (options.implicit.empty() ? options.volume.path + " is none" : "--implicit is a formula"));
  }
  const char* const with = options.start == "persistent"       ? "--start persistent"
                           : options.restricted == "all"       ? "--restricted all"
                           : options.algorithm != "delsurf" ? "--algorithm delsurf1"
                                                               : nullptr;
  if (with != nullptr) throw OptionError("--feature-angle: not with " + std::string(with));
}

}  // namespace

void add_meshing_options(CLI::App& app, MeshingOptions& options) {
  add_input(app, options);
  if (options.input != InputKind::kPolygons) add_formula_options(app, options.implicit, options.box, "In place of a volume");
  add_mesh_output_options(app, options.output);
  if (options.kind == MeshKind::kTets) {
    add_tet_output_options(app, options.output);
    if (options.input != InputKind::kPolygons) add_image_material_options(app, options.image_materials);
  } else {
    add_unit_option(app, options.output.unit);
  }
  add_variant_options(app, options);
  add_size_options(app, options);
  add_shape_options(app, options);
  if (options.input != InputKind::kPolygons) add_volume_options(app, options);
  add_frame_option(app, options.frame);
  if (options.input != InputKind::kPolygons) exclude_volume_options(app);
  add_limit_options(app, options);
  app.add_option("--report", options.report, "Write what was done and checked to a JSON file")->type_name("FILE.json");
  add_config_option(app);
  add_console_options(app, options.console, JsonFlag::kOffered);
}

void decide_input(const CLI::App& app, MeshingOptions& options) {
  check_algorithm(app, options);
  const std::string& path = options.volume.path;
  const bool samples = options.input != InputKind::kPolygons && holds_samples(app, path);
  const bool polygons = options.input == InputKind::kPolygons || (!samples && is_mesh_path(path));
  check_feature_angle(options, polygons);
  check_dense(app, options);
  if (options.input == InputKind::kPolygons) return;
  if (options.input == InputKind::kVolume && polygons) {
    throw OptionError(path + ": is a polygon surface, no volume; delvox remesh is for those");
  }
  options.input = samples ? InputKind::kSamples : polygons ? InputKind::kPolygons : InputKind::kVolume;
  if (samples) {
    refuse(app, kOfVolumes, "is for volumes, and " + path + " holds samples");
    if (options.algorithm == "delsurf2") {
      throw OptionError("--algorithm delsurf2: is for smooth formulas and volumes, and " + path + " holds samples");
    }
    return;
  }
  refuse(app, kOfSamples, "is for scattered samples (.csv .tsv .txt .vtu)");
  if (!polygons) return;
  refuse(app, kOfIsosurfaces, "is for volumes, and " + path + " is a polygon surface");
  refuse(app, kOfVolumes, "is for volumes, and " + path + " is a polygon surface");
}

}  // namespace delvox::tools
