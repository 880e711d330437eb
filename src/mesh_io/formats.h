#pragma once

#include <span>

#include "mesh_io/out.h"
#include "mesh_io/raw_mesh.h"
#include "mesh_io/source.h"

namespace delvox::mesh_io {

/// A mesh to be written: a surface, or tets and their boundary.
struct MeshView {
  std::span<const Point3> points;
  std::span<const Triangle> triangles;           ///< the surface, or the boundary of the tets
  std::span<const Tet> tets;                     ///< empty for a surface
  std::span<const Label> regions;                ///< one per tet, or empty: all 1
  std::span<const std::uint8_t> on_surface;      ///< one per point, or empty: not known
  const MeshInfo& info;
  bool is_tet_mesh;

  Label region(std::size_t tet) const { return regions.empty() ? 1 : regions[tet]; }
};

void write_vtu(const MeshView& mesh, Out& out);
void write_legacy_vtk(const MeshView& mesh, Out& out);
void write_stl(const MeshView& mesh, Out& out);
void write_ply(const MeshView& mesh, Out& out);
void write_off(const MeshView& mesh, Out& out);
void write_obj(const MeshView& mesh, Out& out);
void write_medit(const MeshView& mesh, Out& out);
void write_gmsh41(const MeshView& mesh, Out& out);
void write_gmsh22(const MeshView& mesh, Out& out);
void write_abaqus(const MeshView& mesh, Out& out);

RawMesh read_vtu(const Source& source);
RawMesh read_legacy_vtk(const Source& source);
RawMesh read_stl(const Source& source);
RawMesh read_ply(const Source& source);
RawMesh read_off(const Source& source);
RawMesh read_obj(const Source& source);
RawMesh read_medit(const Source& source);
RawMesh read_gmsh(const Source& source);
RawMesh read_abaqus(const Source& source);

}  // namespace delvox::mesh_io
