#include "meshing/pieces.h"

namespace delvox {
namespace {

void flood(const RestrictedDelaunay& delaunay, CellId start, std::uint32_t piece, std::vector<std::uint32_t>& of_cell) {
  std::vector<CellId> stack{start};
  of_cell[start] = piece;
  while (!stack.empty()) {
    const CellId cell = stack.back();
    stack.pop_back();
    for (CellId next : delaunay.neighbors(cell)) {
      if (of_cell[next] != kNone || next == RestrictedDelaunay::kBeyond) continue;
      if (delaunay.label(next) != delaunay.label(cell)) continue;
      of_cell[next] = piece;
      stack.push_back(next);
    }
  }
}

}  // namespace

Pieces find_pieces(const RestrictedDelaunay& delaunay) {
  Pieces pieces{std::vector<std::uint32_t>(delaunay.cell_capacity(), kNone), 0};
  for (CellId cell = RestrictedDelaunay::kBeyond + 1; cell < delaunay.cell_capacity(); ++cell) {
    if (pieces.of_cell[cell] != kNone || delaunay.stamp(cell) == 0) continue;
    flood(delaunay, cell, pieces.count++, pieces.of_cell);
  }
  return pieces;
}

}  // namespace delvox
