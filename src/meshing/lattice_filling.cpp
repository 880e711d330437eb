#include "meshing/interior_lattice.h"
#include "meshing/refinement.h"

namespace delvox {

void Refinement::fill_interior(const TetCriteria& criteria) {
  // Deep sites are what a lattice saves: the others are inserted one by one, as refinement does. In thin bodies, laying
  // it out takes longer than that.
  constexpr double kFewestDeep = 1.0 / 16;  // for each vertex that there is
  if (!criteria.cell_size.constant() || !budget_left()) return;
  const double fewest = kFewestDeep * static_cast<double>(vertex_count());
  if (InteriorLattice::expected_deep(delaunay_, criteria.cell_size.maximum()) < fewest) return;
  InteriorLattice lattice(delaunay_, criteria.cell_size.maximum(), [this] { return budget_left(); });
  // A run that is to stop there anyway stops with refined tets rather than with half a lattice.
  if (!budget_.room_for(vertex_count() + lattice.site_count())) return;
  lattice.find_depths();
  do {
    insert_shell(lattice);
    refine();  // step 2 removes the sites that disturb the surface
    if (!budget_left()) return;
  } while (lattice.adapt(delaunay_));
  lattice_stamp_ = lattice.add_deep(delaunay_);
  report_.interior_insertions += lattice.deep().size();
  mark_lost_dirty();
  note_new_facets();
  enqueue_created();
}

void Refinement::insert_shell(InteriorLattice& lattice) {
  report_.interior_insertions += lattice.insert_shell(delaunay_, [this] { return budget_left(); });
  mark_lost_dirty();
  note_new_facets();
  enqueue_created();
}

}  // namespace delvox
