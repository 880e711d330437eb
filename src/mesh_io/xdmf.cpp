// XDMF 3 with HDF5 beside it, as dolfinx and ParaView read it: https://www.xdmf.org/index.php/XDMF_Model_and_Format
// One grid with the mesh, its regions and sets of nodes and tets; sets of faces in a file of their own, since meshio
// takes one grid a file and dolfinx one tag a grid. dolfinx opens a .h5 of the same stem for each .xdmf.
#include <string>
#include <vector>

#include "mesh_io/formats.h"
#include "mesh_io/hdf5_image.h"
#include "mesh_io/header_comment.h"
#include "mesh_io/set_suffix.h"

namespace delvox::mesh_io {
namespace {

template <class NodesOf>
std::vector<std::int64_t> all_nodes(std::size_t cells, const NodesOf& nodes_of) {
  std::vector<std::int64_t> result;
  for (std::size_t i = 0; i < cells; ++i) {
    const CellNodes nodes = nodes_of(i);
    result.insert(result.end(), nodes.begin(), nodes.end());
  }
  return result;
}

template <class Index>
std::vector<std::int32_t> flags_of(std::size_t count, const std::vector<Index>& members) {
  std::vector<std::int32_t> flags(count, 0);
  for (Index member : members) flags[member] = 1;
  return flags;
}

std::size_t cell_count(const MeshView& mesh) {
  return mesh.is_tet_mesh ? mesh.tets.size() : mesh.triangles.size();
}
std::size_t nodes_per_cell(const MeshView& mesh) {
  return !mesh.is_tet_mesh ? 3 : mesh.second_order() ? 10 : 4;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (char c : text) result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return result;
}

/// A reference to an array of the HDF5 file.
std::string item(const std::string& file, const std::string& dims, const char* type, int bytes,
                 const std::string& path) {
  return "<DataItem Dimensions=\"" + dims + "\" NumberType=\"" + type + "\" Precision=\"" + std::to_string(bytes) +
         "\" Format=\"HDF\">" + escaped(file) + ":" + path + "</DataItem>";
}

void put_head(const MeshView& mesh, Out& out) {
  out.put("<?xml version=\"1.0\"?>\n<!-- ", header_comment(mesh.info), " -->\n<Xdmf Version=\"3.0\">\n<Domain>\n");
}

void put_geometry(const MeshView& mesh, const std::string& file, Out& out) {
  out.put("<Geometry GeometryType=\"XYZ\">",
          item(file, std::to_string(mesh.points.size()) + " 3", "Float", 8, "/mesh/geometry"), "</Geometry>\n");
}

void put_topology(const std::string& file, const char* type, std::size_t cells, std::size_t nodes,
                  const std::string& path, Out& out) {
  out.put("<Topology TopologyType=\"", type, "\" NumberOfElements=\"", cells, "\" NodesPerElement=\"", nodes, "\">",
          item(file, std::to_string(cells) + " " + std::to_string(nodes), "Int", 8, path), "</Topology>\n");
}

void put_attribute(const std::string& file, const std::string& name, const char* center, std::size_t count,
                   const std::string& path, Out& out) {
  out.put("<Attribute Name=\"", name, "\" AttributeType=\"Scalar\" Center=\"", center, "\">",
          item(file, std::to_string(count), "Int", 4, path), "</Attribute>\n");
}

void add_geometry(const MeshView& mesh, Hdf5Image& image) {
  image.group("/mesh");
  std::vector<double> coordinates;
  coordinates.reserve(3 * mesh.points.size());
  for (const Point3& p : mesh.points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  image.array("/mesh/geometry", coordinates, 3);
}

}  // namespace

void write_xdmf(const MeshView& mesh, Out& out) {
  const std::string file = mesh.stem + ".h5";
  put_head(mesh, out);
  out.put("<Grid Name=\"mesh\" GridType=\"Uniform\">\n");
  const char* type = !mesh.is_tet_mesh ? "Triangle" : mesh.second_order() ? "Tetrahedron_10" : "Tetrahedron";
  put_topology(file, type, cell_count(mesh), nodes_per_cell(mesh), "/mesh/topology", out);
  put_geometry(mesh, file, out);
  if (mesh.is_tet_mesh) put_attribute(file, "region", "Cell", mesh.tets.size(), "/mesh/region", out);
  for (const MeshSet& set : mesh.sets) {
    if (!set.tets.empty()) {
      put_attribute(file, set.name + kTetsSuffix, "Cell", mesh.tets.size(), "/sets/" + set.name + kTetsSuffix, out);
    }
    if (!set.nodes.empty()) {
      put_attribute(file, set.name + kNodesSuffix, "Node", mesh.points.size(), "/sets/" + set.name + kNodesSuffix, out);
    }
  }
  out.put("</Grid>\n</Domain>\n</Xdmf>\n");
}

void write_xdmf_arrays(const MeshView& mesh, Out& out) {
  Hdf5Image image;
  add_geometry(mesh, image);
  const auto nodes_of = [&](std::size_t i) { return mesh.is_tet_mesh ? mesh.tet_nodes(i) : mesh.triangle_nodes(i); };
  image.array("/mesh/topology", all_nodes(cell_count(mesh), nodes_of), nodes_per_cell(mesh));
  if (mesh.is_tet_mesh) {
    std::vector<std::int32_t> regions(mesh.tets.size());
    for (std::size_t t = 0; t < regions.size(); ++t) regions[t] = mesh.region(t);
    image.array("/mesh/region", std::span<const std::int32_t>(regions));
  }
  image.group("/sets");
  for (const MeshSet& set : mesh.sets) {
    const std::string path = "/sets/" + set.name;
    if (!set.tets.empty()) {
      image.array(path + kTetsSuffix, std::span<const std::int32_t>(flags_of(mesh.tets.size(), set.tets)));
    }
    if (!set.nodes.empty()) {
      image.array(path + kNodesSuffix, std::span<const std::int32_t>(flags_of(mesh.points.size(), set.nodes)));
    }
  }
  out.bytes(image.bytes());
}

void write_xdmf_facets(const MeshView& mesh, Out& out) {
  const std::string file = mesh.stem + "_facets.h5";
  put_head(mesh, out);
  for (const MeshSet& set : mesh.sets) {
    if (set.faces.empty()) continue;
    const std::string path = "/sets/" + set.name;
    out.put("<Grid Name=\"", set.name, "\" GridType=\"Uniform\">\n");
    put_topology(file, mesh.second_order() ? "Triangle_6" : "Triangle", set.faces.size(), mesh.second_order() ? 6 : 3,
                 path + "_topology", out);
    put_geometry(mesh, file, out);
    put_attribute(file, set.name, "Cell", set.faces.size(), path, out);
    out.put("</Grid>\n");
  }
  out.put("</Domain>\n</Xdmf>\n");
}

void write_xdmf_facet_arrays(const MeshView& mesh, Out& out) {
  Hdf5Image image;
  add_geometry(mesh, image);
  image.group("/sets");
  for (const MeshSet& set : mesh.sets) {
    if (set.faces.empty()) continue;
    const std::string path = "/sets/" + set.name;
    const auto face_nodes = [&](std::size_t i) { return mesh.face_nodes(set.faces[i]); };
    image.array(path + "_topology", all_nodes(set.faces.size(), face_nodes), mesh.second_order() ? 6 : 3);
    image.array(path, std::span<const std::int32_t>(std::vector<std::int32_t>(set.faces.size(), 1)));
  }
  out.bytes(image.bytes());
}

}  // namespace delvox::mesh_io
