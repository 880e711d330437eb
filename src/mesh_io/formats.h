#pragma once

#include "mesh_io/mesh_view.h"
#include "mesh_io/out.h"
#include "mesh_io/raw_mesh.h"
#include "mesh_io/source.h"

namespace delvox::mesh_io {

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
void write_febio(const MeshView& mesh, Out& out);
void write_nastran(const MeshView& mesh, Out& out);
void write_unv(const MeshView& mesh, Out& out);
void write_med(const MeshView& mesh, Out& out);
// A mesh and its arrays, sets of faces and their arrays; the first and third name the others by MeshView::stem.
void write_xdmf(const MeshView& mesh, Out& out);
void write_xdmf_arrays(const MeshView& mesh, Out& out);
void write_xdmf_facets(const MeshView& mesh, Out& out);
void write_xdmf_facet_arrays(const MeshView& mesh, Out& out);

RawMesh read_vtu(const Source& source);
RawMesh read_legacy_vtk(const Source& source);
RawMesh read_stl(const Source& source);
RawMesh read_ply(const Source& source);
RawMesh read_off(const Source& source);
RawMesh read_obj(const Source& source);
RawMesh read_medit(const Source& source);
RawMesh read_gmsh(const Source& source);
RawMesh read_abaqus(const Source& source);
RawMesh read_febio(const Source& source);
RawMesh read_nastran(const Source& source);
RawMesh read_unv(const Source& source);

}  // namespace delvox::mesh_io
