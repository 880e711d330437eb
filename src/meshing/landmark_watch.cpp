#include "meshing/landmark_watch.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "core/sort_by_key.h"
#include "delaunay/spatial_order.h"

namespace delvox {
namespace {

/// Groups 0..keys.size()-1 by their keys, each below `groups`, keeping their order: first[g] is where group g begins.
void group_by(const std::vector<std::size_t>& keys, std::size_t groups, std::vector<std::uint32_t>& first,
              std::vector<std::uint32_t>& members) {
  first.assign(groups + 1, 0);
  for (std::size_t key : keys) ++first[key + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  members.resize(keys.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) members[next[keys[i]]++] = i;
}

}  // namespace

Landmarks along_curve(const Landmarks& landmarks) {
  Box3 box;
  for (const Point3& p : landmarks.points) box.extend(p);
  constexpr std::size_t kChunk = 4096;
  std::vector<KeyedIndex> entries(landmarks.points.size());
  for_each_chunk(entries.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      entries[i] = {place_along_curve(landmarks.points[i], box), static_cast<std::uint32_t>(i)};
    }
  });
  sort_by_key(entries);
  Landmarks result;
  std::vector<std::uint32_t> number(entries.size());
  result.points.reserve(entries.size());
  for (const KeyedIndex& entry : entries) {
    number[entry.index] = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back(landmarks.points[entry.index]);
  }
  entries.clear();
  for (const auto& [a, b] : landmarks.links) {
    entries.push_back({std::min(number[a], number[b]), static_cast<std::uint32_t>(entries.size())});
  }
  sort_by_key(entries);
  result.links.reserve(entries.size());
  for (const KeyedIndex& entry : entries) {
    const auto& [a, b] = landmarks.links[entry.index];
    result.links.push_back({number[a], number[b]});
  }
  return result;
}

LandmarkWatch::LandmarkWatch(Landmarks landmarks)
    : points_(std::move(landmarks.points)), links_(std::move(landmarks.links)) {
  for (const auto& [a, b] : links_) {
    const Vector3 link = points_[a] - points_[b];
    for (int axis = 0; axis < 3; ++axis) reach_[axis] = std::max(reach_[axis], std::abs(link[axis]));
    longest_link_ = std::max(longest_link_, norm(link));
  }
  std::vector<std::size_t> ends;
  for (const auto& [a, b] : links_) ends.insert(ends.end(), {a, b});
  group_by(ends, points_.size(), first_link_, links_of_);
  for (std::uint32_t& end : links_of_) end /= 2;
  waits_.assign(links_.size(), false);
  first_change_.assign(points_.size(), kNone);
  if (!points_.empty()) sort_into_cubes();
}

void LandmarkWatch::sort_into_cubes() {
  for (const Point3& p : points_) box_.extend(p);
  // Landmarks lie on the surface's voxels: cubes of two links' width hold a handful each.
  const double most_cubes = static_cast<double>(points_.size()) + 64;
  const Vector3 extent = box_.max - box_.min;
  const double two_links = 2 * std::max({reach_.x, reach_.y, reach_.z});
  width_ = std::max({two_links, std::cbrt(extent.x * extent.y * extent.z / most_cubes), 1e-300, box_.diagonal() / 1000});
  for (int axis = 0; axis < 3; ++axis) counts_[axis] = static_cast<int>(extent[axis] / width_) + 1;
  std::vector<std::size_t> cubes;
  for (const Point3& p : points_) cubes.push_back(cube_index(cube_of(p)));
  group_by(cubes, static_cast<std::size_t>(counts_[0]) * counts_[1] * counts_[2], first_in_cube_, in_cubes_);
}

std::array<int, 3> LandmarkWatch::cube_of(const Point3& p) const {
  std::array<int, 3> cube;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::clamp((p[axis] - box_.min[axis]) / width_, 0.0, counts_[axis] - 1.0);
    cube[axis] = static_cast<int>(at);
  }
  return cube;
}

void LandmarkWatch::note_change(const Box3& box, VertexId near) {
  if (!all_ && !empty()) changes_.push_back({box, near});
}

std::vector<LandmarkWatch::Due> LandmarkWatch::take_due() {
  std::vector<Due> due;
  if (all_) {
    for (std::uint32_t i = 0; i < points_.size(); ++i) due.push_back({i, kNone});
    all_ = false;
    return due;
  }
  constexpr std::size_t kChunk = 128;
  due = gather_chunks<Due>(changes_.size(), kChunk, [&](std::size_t begin, std::size_t end, std::vector<Due>& found) {
    for (std::size_t change = begin; change < end; ++change) add_due(static_cast<std::uint32_t>(change), found);
  });
  for (Due& d : due) d.near = changes_[std::exchange(first_change_[d.landmark], kNone)].near;
  changes_.clear();
  std::sort(due.begin(), due.end(), [](const Due& a, const Due& b) { return a.landmark < b.landmark; });
  return due;
}

/// The landmarks near a change that no other change has met so far. Of several that meet one at the same time the first
/// is kept, whoever comes first.
void LandmarkWatch::add_due(std::uint32_t change, std::vector<Due>& due) {
  const Box3 box{changes_[change].box.min - reach_, changes_[change].box.max + reach_};
  const auto low = cube_of(box.min), high = cube_of(box.max);
  const auto meet = [&](std::uint32_t landmark) {
    const std::atomic_ref<std::uint32_t> first(first_change_[landmark]);
    std::uint32_t known = first.load(std::memory_order_relaxed);
    if (known <= change || !box.contains(points_[landmark])) return;
    while (change < known && !first.compare_exchange_weak(known, change, std::memory_order_relaxed)) {
    }
    if (known == kNone) due.push_back({landmark, kNone});
  };
  std::array<int, 3> cube;
  for (cube[2] = low[2]; cube[2] <= high[2]; ++cube[2]) {
    for (cube[1] = low[1]; cube[1] <= high[1]; ++cube[1]) {
      cube[0] = low[0];
      const std::uint32_t* const first = &first_in_cube_[cube_index(cube)];
      // Cubes along this axis follow each other.
      for (std::uint32_t i = first[0]; i < first[high[0] - low[0] + 1]; ++i) meet(in_cubes_[i]);
    }
  }
}

void LandmarkWatch::await_links_of(const std::vector<Due>& landmarks) {
  for (const Due& due : landmarks) {
    for (std::uint32_t i = first_link_[due.landmark]; i < first_link_[due.landmark + 1]; ++i) {
      if (waits_[links_of_[i]]) continue;
      waits_[links_of_[i]] = true;
      waiting_links_.push_back(links_of_[i]);
    }
  }
}

std::vector<std::uint32_t> LandmarkWatch::take_links() {
  std::vector<std::uint32_t> links;
  links.swap(waiting_links_);
  for (std::uint32_t link : links) waits_[link] = false;
  return links;
}

}  // namespace delvox
