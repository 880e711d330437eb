#include <algorithm>

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
  if (!set_deep_aside()) insert_deep();
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

/// The deep sites become vertices like others: refinement has come near them.
void Refinement::insert_deep() {
  delaunay_.take_back();
  const std::vector<Point3> points = std::move(deep_->points);
  deep_.reset();
  delaunay_.insert_interior(points, always_go_on);
  note_new_facets();
  enqueue_created();
}

/// As RestrictedDelaunay::evaluate, of the whole mesh. Cells known before, the hint too, are gone afterwards if it has
/// come near the deep sites.
const Star& Refinement::evaluate(const Point3& p, CellId hint) {
  const bool known = delaunay_.stamp(hint) != 0;
  const Star& star = delaunay_.evaluate(p, known ? hint : delaunay_.some_cell());
  if (!delaunay_.disturbs_aside(star.zone)) return star;
  insert_deep();
  return delaunay_.evaluate(p, delaunay_.some_cell());
}

}  // namespace delvox
