#include "delaunay/hole_filling.h"

#include <algorithm>
#include <stdexcept>

namespace delvox {

void Delaunay3::HoleFilling::find(const Delaunay3& whole, VertexId vertex, const std::vector<CellId>& cells) {
  insert_neighbours(whole, vertex, cells);
  find_walls(whole, vertex, cells);
  flood();
}

void Delaunay3::HoleFilling::insert_neighbours(const Delaunay3& whole, VertexId vertex,
                                               const std::vector<CellId>& cells) {
  around_.clear();
  name_in_around_.clear();
  for (CellId cell : cells) {
    for (VertexId v : whole.vertices(cell)) {
      if (v != vertex) name_in_around_.push_back({v, v});
    }
  }
  std::sort(name_in_around_.begin(), name_in_around_.end());
  name_in_around_.erase(std::unique(name_in_around_.begin(), name_in_around_.end()), name_in_around_.end());
  name_in_whole_ = {0, 1, 2, 3};
  CellId hint = around_.cell_of(0);
  for (auto& [in_whole, in_around] : name_in_around_) {
    if (in_whole < kCorners) continue;  // the corners are the same in both
    around_.evaluate(whole.point(in_whole), hint, star_);
    in_around = around_.commit(star_, created_);
    name_in_whole_.push_back(in_whole);
    hint = created_.front();
  }
}

void Delaunay3::HoleFilling::find_walls(const Delaunay3& whole, VertexId vertex, const std::vector<CellId>& cells) {
  const auto renamed = [this](VertexId v) {
    return std::lower_bound(name_in_around_.begin(), name_in_around_.end(), std::pair(v, VertexId{0}))->second;
  };
  walls_.clear();
  for (CellId cell : cells) {
    const auto& corners = whole.vertices(cell);
    const FacetId wall{cell, static_cast<int>(std::find(corners.begin(), corners.end(), vertex) - corners.begin())};
    const auto v = whole.vertices(wall);
    const bool hull = whole.neighbors(cell)[wall.index] == kOutside;
    walls_.push_back(
        {canonical({renamed(v[0]), renamed(v[1]), renamed(v[2])}), hull ? FacetId{kOutside, 0} : whole.mirror(wall)});
  }
  std::sort(walls_.begin(), walls_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
}

/// What lies beyond a facet of around_, if it is a wall and its cell is on the inner side of that.
const FacetId* Delaunay3::HoleFilling::wall_at(FacetId facet) const {
  const Corners key = canonical(around_.vertices(facet));
  const auto wall = std::lower_bound(walls_.begin(), walls_.end(), key,
                                     [](const auto& entry, const Corners& sought) { return entry.first < sought; });
  return wall != walls_.end() && wall->first == key ? &wall->second : nullptr;
}

/// The cell of around_ on the inner side of a wall.
CellId Delaunay3::HoleFilling::cell_inside(const Corners& wall) const {
  for (CellId cell = kOutside + 1; cell < around_.cell_capacity(); ++cell) {
    const auto& v = around_.vertices(cell);
    if (around_.stamp(cell) == 0 || std::find(v.begin(), v.end(), wall.front()) == v.end()) continue;
    for (int i = 0; i < 4; ++i) {
      if (canonical(around_.vertices(FacetId{cell, i})) == wall) return cell;
    }
  }
  throw std::logic_error("the cells around a vertex leave no hole");
}

std::uint32_t Delaunay3::HoleFilling::number_of(CellId cell) {
  if (numbers_[cell] == kNone) {
    numbers_[cell] = static_cast<std::uint32_t>(filling_.size());
    filling_.push_back(cell);
  }
  return numbers_[cell];
}

/// From a cell inside the walls on to all that are not beyond one.
void Delaunay3::HoleFilling::flood() {
  numbers_.assign(around_.cell_capacity(), kNone);
  filling_.clear();
  tets_.clear();
  number_of(cell_inside(walls_.front().first));
  for (std::size_t next = 0; next < filling_.size(); ++next) {
    const CellId cell = filling_[next];
    Tet tet;
    for (int i = 0; i < 4; ++i) {
      tet.vertices[i] = name_in_whole_[around_.vertices(cell)[i]];
      if (const FacetId* outer = wall_at({cell, i})) {
        tet.sides[i].outer = *outer;
      } else {
        tet.sides[i].tet = number_of(around_.neighbors(cell)[i]);
      }
    }
    tet.sphere = around_.sphere(cell);
    tets_.push_back(tet);
  }
}

}  // namespace delvox
