// STL: triangles without shared points, float32. https://www.fabbers.com/tech/STL_Format
#include <bit>
#include <cstring>
#include <unordered_map>

#include "mesh_io/binary.h"
#include "mesh_io/formats.h"
#include "mesh_io/header_comment.h"

namespace delvox::mesh_io {
namespace {

constexpr std::size_t kHeaderSize = 80, kStartOfTriangles = 84, kTriangleSize = 50;

struct HashOfPoint {
  std::size_t operator()(const Point3& p) const {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(p[axis])) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

/// Gives equal corners the same index, in the order of first use.
class Merger {
 public:
  explicit Merger(RawMesh& mesh, std::size_t triangles) : mesh_(mesh) {
    index_.reserve(triangles / 2 + 8);
    mesh_.triangles.reserve(triangles);
  }
  /// A triangle whose corners coincide after rounding is dropped: its neighbours then meet along its edge.
  void add(const std::array<Point3, 3>& corners) {
    const Triangle triangle{index_of(corners[0]), index_of(corners[1]), index_of(corners[2])};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) return;
    mesh_.triangles.push_back(triangle);
  }

 private:
  std::uint32_t index_of(Point3 p) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += 0.0;  // -0 and 0 are the same place
    const auto [found, fresh] = index_.try_emplace(p, static_cast<std::uint32_t>(mesh_.points.size()));
    if (fresh) mesh_.points.push_back(p);
    return found->second;
  }

  RawMesh& mesh_;
  std::unordered_map<Point3, std::uint32_t, HashOfPoint> index_;
};

void read_binary(const Source& source, std::size_t count, RawMesh& mesh) {
  read_header_comment(std::string_view(source.bytes).substr(0, kHeaderSize), mesh.info);
  Merger merger(mesh, count);
  for (std::size_t t = 0; t < count; ++t) {
    const char* corner = source.bytes.data() + kStartOfTriangles + t * kTriangleSize + 12;
    std::array<Point3, 3> corners;
    for (Point3& p : corners) {
      for (int axis = 0; axis < 3; ++axis, corner += 4) p[axis] = load<float>(corner, std::endian::little);
    }
    merger.add(corners);
  }
}

void read_ascii(const Source& source, RawMesh& mesh) {
  TextCursor cursor(source, source.bytes);
  read_header_comment(cursor.line(), mesh.info);
  Merger merger(mesh, cursor.remaining() / 128);
  std::array<Point3, 3> corners;
  std::size_t corner = 0;
  bool ended = false;
  while (cursor.more()) {
    const std::string word = upper_case(cursor.token());
    if (word == "VERTEX") {
      if (corner == 3) source.fail("a facet has more than three corners", "triangulate it with another tool first");
      for (int axis = 0; axis < 3; ++axis) corners[corner][axis] = cursor.real();
      ++corner;
    } else if (word == "ENDFACET") {
      if (corner != 3) source.fail("a facet does not have three corners");
      merger.add(corners);
      corner = 0;
    } else if (word == "ENDSOLID" || word == "SOLID") {
      ended = word == "ENDSOLID";
      cursor.line();  // the name
    }
  }
  if (!ended || corner != 0) source.fail("ends before its endsolid");
}

}  // namespace

void write_stl(const MeshView& mesh, Out& out) {
  std::string header = header_comment(mesh.info);
  header.resize(kHeaderSize, ' ');
  out.put(header);
  constexpr auto kOrder = std::endian::little;
  out.binary(static_cast<std::uint32_t>(mesh.triangles.size()), kOrder);
  for (const Triangle& triangle : mesh.triangles) {
    const Point3 &a = mesh.points[triangle[0]], &b = mesh.points[triangle[1]], &c = mesh.points[triangle[2]];
    Vector3 normal = cross(b - a, c - a);
    const double length = norm(normal);
    normal = length > 0 ? (1.0 / length) * normal : Vector3{};
    for (const Point3& p : {normal, a, b, c}) {
      for (int axis = 0; axis < 3; ++axis) out.binary(static_cast<float>(p[axis]), kOrder);
    }
    out.binary(std::uint16_t{0}, kOrder);
  }
}

RawMesh read_stl(const Source& source) {
  RawMesh mesh;
  mesh.coordinate_error = kFloat32Error;
  const std::string_view bytes = source.bytes;
  std::uint64_t claimed = 0;
  if (bytes.size() >= kStartOfTriangles) claimed = load<std::uint32_t>(bytes.data() + kHeaderSize, std::endian::little);
  const std::uint64_t needed = kStartOfTriangles + kTriangleSize * claimed;
  // Many programs begin binary files with "solid" too: a count that fits the size to the byte decides.
  const bool says_solid = upper_case(bytes.substr(0, 5)) == "SOLID";
  if (needed == bytes.size() || (!says_solid && claimed > 0 && needed < bytes.size())) {
    read_binary(source, claimed, mesh);
  } else if (says_solid) {
    read_ascii(source, mesh);
  } else if (bytes.size() < kStartOfTriangles) {
    source.fail("is too short for an STL file");
  } else {
    source.fail("claims " + std::to_string(claimed) + " triangles, which " + std::to_string(bytes.size()) +
                " bytes cannot hold");
  }
  return mesh;
}

}  // namespace delvox::mesh_io
