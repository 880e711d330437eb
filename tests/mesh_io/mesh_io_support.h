#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "delvox/core/mesh.h"
#include "delvox/meshing/second_order.h"

namespace delvox::testing {

/// A folder of its own that is gone with the object; in memory where that is to be had, for thousands of small files.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const bool has_memory_disk = ::access("/dev/shm", W_OK | X_OK) == 0;
    const std::filesystem::path parent = has_memory_disk ? "/dev/shm" : std::filesystem::temp_directory_path();
    std::string name = (parent / "delvox_mesh_io_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Two tets of two regions on five points with coordinates that are awkward to print; every point is used.
inline TetMesh awkward_tets() {
  TetMesh mesh;
  mesh.points = {{1e-9, -1e-9, 0.1}, {123456.789012345, 0, 1.0 / 3}, {-7.25, 98765.4321098765, 0},
                 {0.1 + 0.2, -2.5e-7, 54321.0987654321}, {123456.789012345, 98765.4321098765, 54321.09876543219}};
  mesh.tets = {{0, 1, 2, 3}, {1, 4, 2, 3}};
  mesh.regions = {7, 2};
  mesh.boundary = boundary_of(mesh.tets);
  mesh.on_surface = {1, 0, 1, 1, 1};
  mesh.info.frame = Frame::kLps;
  mesh.info.promises.min_angle_degrees = 30;
  mesh.info.promises.radius_edge = 2;
  mesh.info.promises.size = 1.0 / 3;
  mesh.info.promises.min_dihedral_degrees = 5.5;
  mesh.info.isovalue = 2.9;
  mesh.info.below = true;
  mesh.info.complete = false;
  return mesh;
}

/// Those tets with mid-side nodes, some of them off the middle, complete, and sets that overlap; names in capitals.
inline TetMesh awkward_tets_with_sets() {
  TetMesh mesh = awkward_tets();
  mesh.info.complete = true;
  make_second_order(mesh, nullptr);
  for (std::size_t i = 5; i < mesh.points.size(); ++i) mesh.points[i].x += 0.125 * static_cast<double>(i);
  mesh.on_surface.assign(mesh.points.size(), 1);
  mesh.sets = {{"NODES-ONLY", {0, 3, 7}, {}, {}},
               {"TETS", {}, {1}, {}},
               {"ALL_3", {0, 1, 2, 3}, {0, 1}, {{0, 1}, {0, 2}, {1, 0}}},
               {"FACES", {}, {}, {{0, 2}, {1, 3}}}};
  return mesh;
}

/// The surface of those tets.
inline SurfaceMesh awkward_surface() {
  SurfaceMesh mesh = boundary_surface(awkward_tets());
  mesh.info = {};
  mesh.info.frame = Frame::kRas;
  mesh.info.promises.cell_size = 1.5;
  mesh.info.promises.grade = 0.3;
  mesh.info.promises.max_deviation = 0.1;
  mesh.info.open_border = true;
  return mesh;
}

}  // namespace delvox::testing
