#include <algorithm>
#include <limits>

#include "delvox/core/mesh.h"
#include "meshing/interior_lattice.h"
#include "meshing/refinement.h"

namespace delvox {

void Refinement::fill_interior(const TetCriteria& criteria) {
  if (!criteria.cell_size.constant() || !budget_left()) return;
  InteriorLattice lattice(delaunay_, criteria.cell_size.maximum(), [this] { return budget_left(); });
  // A run that is to stop there anyway stops with refined tets rather than with half a lattice.
  if (!budget_.room_for(vertex_count() + lattice.site_count())) return;
  lattice.find_depths();
  do {
    insert_shell(lattice);
    refine();  // step 2 removes the sites that disturb the surface
    if (!budget_left()) return;
  } while (lattice.adapt(delaunay_));
  deep_ = lattice.deep();
  report_.interior_insertions += deep_->points.size();
  deep_reach_ = 4 * criteria.cell_size.maximum();
  if (!set_deep_aside()) insert_deep({}, std::numeric_limits<double>::infinity());
}

void Refinement::insert_shell(InteriorLattice& lattice) {
  report_.interior_insertions += lattice.insert_shell(delaunay_, [this] { return budget_left(); });
  note_new_facets();
  enqueue_created();
}

/// The walls are the faces of deep tets whose corners are all vertices.
bool Refinement::set_deep_aside() {
  std::vector<WalledRegion::Wall> walls;
  for (const auto& tet : deep_->tets) {
    for (const auto& face : kTetFaces) {
      const auto vertex = [&](int corner) { return deep_->vertex(tet[face[corner]]); };
      const WalledRegion::Wall wall{vertex(0), vertex(1), vertex(2)};
      if (std::count(wall.begin(), wall.end(), kNone) == 0) walls.push_back(wall);
    }
  }
  return delaunay_.set_aside(walls);
}

/// The deep sites around a place to which refinement has come become vertices like others. Setting the others aside
/// takes a look at every cell: after some times the reach doubles, so that it seldom comes to many.
void Refinement::insert_deep(const Point3& place) {
  constexpr int kTimes = 4;
  insert_deep(place, deep_reach_);
  if (++deep_insertions_ % kTimes == 0) deep_reach_ *= 2;
}

void Refinement::insert_deep(const Point3& place, double reach) {
  delaunay_.take_back();
  const std::size_t first = deep_->shell.size();
  const std::vector<VertexId> vertices = delaunay_.insert_interior(deep_->take_near(place, reach), always_go_on);
  std::copy(vertices.begin(), vertices.end(), deep_->shell.begin() + static_cast<std::ptrdiff_t>(first));
  if (deep_->points.empty()) deep_.reset();
  const bool done = !deep_ || set_deep_aside();
  note_new_facets();
  std::vector<CellId> created = delaunay_.created();
  std::erase_if(created, [this](CellId cell) { return delaunay_.placeholder(cell); });
  enqueue(created, queues_);
  if (!done) insert_deep(place, std::numeric_limits<double>::infinity());
}

/// As RestrictedDelaunay::evaluate, of the whole mesh. Cells known before, the hint too, may be gone afterwards if it has
/// come near the deep sites.
const Star& Refinement::evaluate(const Point3& p, CellId hint) {
  while (true) {
    const bool known = delaunay_.stamp(hint) != 0;
    const Star& star = delaunay_.evaluate(p, known ? hint : delaunay_.some_cell());
    if (!delaunay_.disturbs_aside(star.zone)) return star;
    insert_deep(p);
  }
}

}  // namespace delvox
