#include "mesh_io/formats.h"

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "delvox/mesh_io/read_mesh.h"
#include "delvox/mesh_io/write_deck.h"
#include "delvox/mesh_io/write_mesh.h"
#include "mesh_io/abaqus_deck.h"

namespace delvox {
namespace {

using namespace mesh_io;
namespace fs = std::filesystem;

enum class Holds { kSurfaces, kTets, kTetsAndTheirBoundary };

struct Format {
  std::string_view extension;
  const char* name;
  Holds holds;
  void (*write)(const MeshView&, Out&);
  RawMesh (*read)(const Source&);  ///< null: is only written
};

/// Files that one extension needs beside its own, under the same stem.
struct Companion {
  std::string_view extension;
  const char* suffix;
  void (*write)(const MeshView&, Out&);
  bool (*needed)(const MeshView&);
};

constexpr Format kFormats[] = {
    {".vtu", "VTU", Holds::kTets, write_vtu, read_vtu},
    {".vtk", "legacy VTK", Holds::kTets, write_legacy_vtk, read_legacy_vtk},
    {".stl", "STL", Holds::kSurfaces, write_stl, read_stl},
    {".ply", "PLY", Holds::kSurfaces, write_ply, read_ply},
    {".off", "OFF", Holds::kSurfaces, write_off, read_off},
    {".obj", "OBJ", Holds::kSurfaces, write_obj, read_obj},
    {".mesh", "MEDIT", Holds::kTetsAndTheirBoundary, write_medit, read_medit},
    {".msh", "Gmsh MSH", Holds::kTetsAndTheirBoundary, write_gmsh41, read_gmsh},
    {".msh2", "Gmsh MSH", Holds::kTetsAndTheirBoundary, write_gmsh22, read_gmsh},
    {".inp", "Abaqus INP", Holds::kTetsAndTheirBoundary, write_abaqus, read_abaqus},
    {".feb", "FEBio", Holds::kTets, write_febio, read_febio},
    {".bdf", "Nastran", Holds::kTets, write_nastran, read_nastran},
    {".nas", "Nastran", Holds::kTets, write_nastran, read_nastran},
    {".unv", "I-DEAS UNV", Holds::kTetsAndTheirBoundary, write_unv, read_unv},
    {".med", "MED", Holds::kTetsAndTheirBoundary, write_med, nullptr},
    {".xdmf", "XDMF", Holds::kTets, write_xdmf, nullptr},
};

bool has_face_sets(const MeshView& mesh) {
  return std::any_of(mesh.sets.begin(), mesh.sets.end(), [](const MeshSet& set) { return !set.faces.empty(); });
}

constexpr Companion kCompanions[] = {
    {".xdmf", ".h5", write_xdmf_arrays, [](const MeshView&) { return true; }},
    {".xdmf", "_facets.xdmf", write_xdmf_facets, has_face_sets},
    {".xdmf", "_facets.h5", write_xdmf_facet_arrays, has_face_sets},
};

const Format* find_format(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  const auto found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                  [&](const Format& format) { return format.extension == extension; });
  return found == std::end(kFormats) ? nullptr : found;
}

std::string unknown_extension(const fs::path& path) {
  std::string message = path.string() + ": no mesh format has the extension " + in_quotes(path.extension().string()) +
                        "; use one of";
  for (const Format& format : kFormats) message += " " + std::string(format.extension);
  return message;
}

const Format& format_to_write(const fs::path& path) {
  const Format* format = find_format(path);
  if (format == nullptr) throw OptionError(unknown_extension(path));
  return *format;
}

/// The points in the unit that the file is to have; `scaled` keeps them if they differ.
std::span<const Point3> points_in_unit(const std::vector<Point3>& points, LengthUnit unit,
                                       std::vector<Point3>& scaled) {
  if (unit == LengthUnit::kMillimetre) return points;
  scaled.reserve(points.size());
  for (const Point3& p : points) scaled.push_back({p.x / kMmPerMetre, p.y / kMmPerMetre, p.z / kMmPerMetre});
  return scaled;
}

fs::path beside(const fs::path& path, const char* suffix) {
  fs::path result = path.parent_path() / path.stem();
  result += suffix;
  return result;
}

/// Writes a file and its companions, which appear before it does.
void write_files(MeshView mesh, const Format& format, const fs::path& path) {
  if (mesh.deck != nullptr) check_deck(mesh, *mesh.deck);
  mesh.stem = path.stem().string();
  const auto write = [&](OutputFile& file, const auto& write_to) {
    Out out(file.stream());
    write_to(mesh, out);
  };
  std::vector<std::unique_ptr<OutputFile>> companions;
  for (const Companion& companion : kCompanions) {
    if (companion.extension != format.extension || !companion.needed(mesh)) continue;
    companions.push_back(std::make_unique<OutputFile>(beside(path, companion.suffix)));
    write(*companions.back(), companion.write);
  }
  OutputFile file(path);
  write(file, format.write);
  for (const auto& companion : companions) companion->commit();
  file.commit();
}

void write_surface(const SurfaceMesh& mesh, const Format& format, const fs::path& path) {
  std::vector<Point3> scaled;
  write_files({points_in_unit(mesh.points, mesh.info.unit, scaled), mesh.triangles, {}, {}, {}, mesh.info, false},
              format, path);
}

void write_tets(const TetMesh& mesh, const Format& format, const fs::path& path, const StaticDeck* deck = nullptr) {
  if (format.holds == Holds::kSurfaces) {
    write_surface(boundary_surface(mesh), format, path);
    return;
  }
  std::vector<TetFace> faces;
  std::vector<Triangle> computed;
  const bool needs_faces = mesh.boundary.empty() || !mesh.sets.empty() || !mesh.mid_nodes.empty();
  const bool lacking = format.holds == Holds::kTetsAndTheirBoundary && needs_faces;
  if (lacking) {
    faces = boundary_faces(mesh.tets);
    for (TetFace face : faces) computed.push_back(face_corners(mesh.tets, face));
  }
  const std::vector<Triangle>& boundary = lacking ? computed : mesh.boundary;
  std::vector<Point3> scaled;
  write_files({points_in_unit(mesh.points, mesh.info.unit, scaled), boundary, mesh.tets, mesh.regions, mesh.on_surface,
               mesh.info, true, faces, mesh.mid_nodes, mesh.sets, mesh.materials, deck},
              format, path);
}

}  // namespace

std::vector<std::filesystem::path> files_of(const std::filesystem::path& path) {
  const Format& format = format_to_write(path);
  std::vector<fs::path> files{path};
  for (const Companion& companion : kCompanions) {
    if (companion.extension == format.extension) files.push_back(beside(path, companion.suffix));
  }
  return files;
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path) {
  const Format& format = format_to_write(path);
  if (const auto* tets = std::get_if<TetMesh>(&mesh)) {
    write_tets(*tets, format, path);
  } else {
    write_surface(std::get<SurfaceMesh>(mesh), format, path);
  }
}

void write_deck(const TetMesh& mesh, const StaticDeck& deck, const fs::path& path) {
  const Format& format = format_to_write(path);
  if (format.write != write_abaqus) throw OptionError(path.string() + ": decks are written as .inp");
  write_tets(mesh, format, path, &deck);
}

bool is_mesh_path(const std::filesystem::path& path) { return find_format(path) != nullptr; }

MeshFile read_mesh(const std::filesystem::path& path) {
  const Format* format = find_format(path);
  if (format == nullptr) throw InputError(unknown_extension(path));
  if (format->read == nullptr) {
    throw InputError(path.string() + ": " + format->name +
                     " files are written, not read; give the mesh in another format");
  }
  const Source source = load_source(path);
  RawMesh raw = format->read(source);
  double coordinate_error = raw.coordinate_error;
  if (raw.info.unit == LengthUnit::kMetre) coordinate_error = std::max(coordinate_error, 4e-16);
  return {std::move(raw).finish(source), format->name, coordinate_error};
}

}  // namespace delvox
