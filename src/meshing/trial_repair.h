#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "meshing/local_repair.h"

namespace delvox {

/// Repairs slivers that no single change makes better: changes are tried that make things worse at first, and kept if
/// local repair of what they leave behind more than makes up for it. Vertices of the inside are taken out and put in,
/// each in a cavity of its own (as in Delaunay refinement, but where it helps), and edges of the boundary get vertices
/// on the surface.
class TrialRepair {
 public:
  TrialRepair(RepairMesh& mesh, const TetLimits& tets, const SurfaceLimits& surface, LocalRepair& local)
      : mesh_(mesh), tets_(tets), surface_(surface), local_(local) {}

  /// Whether something was found that makes things better.
  bool repair(std::uint32_t tet);
  /// The same by moving all vertices around at once, at random, and repairing that: what is best for each vertex alone
  /// need not be best for all. Takes as long as dozens of other repairs.
  bool shake(std::uint32_t tet);
  std::size_t insertions() const { return insertions_; }
  std::size_t removals() const { return removals_; }

 private:
  struct Insertion {
    double gain;
    Point3 place;
    Change change;
  };

  bool reconnect(std::uint32_t tet);
  bool remove_vertices(std::uint32_t tet);
  bool insert_vertices(std::uint32_t tet);
  bool split_surface_edges(std::uint32_t tet);
  struct NewVertex {
    Point3 place;
    bool on_surface;
  };
  std::vector<std::uint32_t> begin_trial();
  bool end_trial(double gain, std::vector<std::uint32_t> waited);
  double disturb(std::span<const std::uint32_t> vertices, double reach, std::uint64_t seed);
  std::vector<std::uint32_t> neighborhood(std::span<const std::uint32_t> vertices) const;
  bool attempt(const Change& change, double gain, std::optional<NewVertex> vertex = std::nullopt);
  using Edge = std::array<std::uint32_t, 2>;
  std::optional<Point3> split(const Edge& edge, Change& change, double& gain) const;
  double merge(std::uint32_t vertex, std::uint32_t into, Change& change) const;
  std::vector<Point3> places_for(std::uint32_t tet) const;
  std::optional<Insertion> insert(std::uint32_t tet, const Point3& place) const;
  std::size_t fill(const std::vector<std::uint32_t>& cavity, Insertion& insertion) const;
  std::vector<std::uint32_t> cavity_around(std::uint32_t tet, const Point3& place) const;
  double price(const Tet& tet) const;
  double price(const Tet& tet, const Point3& new_vertex) const;

  RepairMesh& mesh_;
  const TetLimits& tets_;
  const SurfaceLimits& surface_;
  LocalRepair& local_;
  double least_gain_ = 0;  // for the sliver under repair
  std::size_t insertions_ = 0, removals_ = 0;
  std::uint64_t shakes_ = 0;  // each is another
  Change change_;
};

}  // namespace delvox
