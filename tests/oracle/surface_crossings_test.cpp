#include "oracle/surface_crossings.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "support/random.h"
#include "support/shapes.h"

namespace delvox {
namespace {

using Edge = std::array<int, 4>;  // lower sample and axis

/// Crossings and their components straight from the definition: every edge of the padded grid is looked at, every face,
/// and where four edges of a face are crossed the bilinear function decides at its saddle.
class BruteForce {
 public:
  BruteForce(const Volume& volume, const LevelSet& level_set) : level_(level_set.level) {
    for (int axis = 0; axis < 3; ++axis) size_[axis] = volume.dims()[axis] + 2;
    samples_.resize(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]);
    copy_padded_block(volume, level_set, {-1, -1, -1}, size_, samples_.data());
    for_each_sample([this](const std::array<int, 3>& s) {
      for (int axis = 0; axis < 3; ++axis) find_crossing(s, axis);
    });
    for_each_sample([this](const std::array<int, 3>& s) {
      for (int axis = 0; axis < 3; ++axis) join_face(s, axis);
    });
  }

  const std::map<Edge, double>& positions() const { return positions_; }
  Edge representative(const Edge& e) {
    Edge& parent = parent_.at(e);
    if (parent != e) parent = representative(parent);
    return parent;
  }
  std::size_t components() const {
    std::size_t count = 0;
    for (const auto& [edge, parent] : parent_) count += edge == parent;
    return count;
  }

 private:
  template <class Visit>
  void for_each_sample(const Visit& visit) const {
    for (int k = 0; k < size_[2]; ++k) {
      for (int j = 0; j < size_[1]; ++j) {
        for (int i = 0; i < size_[0]; ++i) visit(std::array{i, j, k});
      }
    }
  }
  double at(const std::array<int, 3>& s) const {
    return samples_[(static_cast<std::size_t>(s[2]) * size_[1] + s[1]) * size_[0] + s[0]] - level_;
  }
  static std::array<int, 3> plus(std::array<int, 3> s, int axis) {
    ++s[axis];
    return s;
  }
  static Edge edge(const std::array<int, 3>& s, int axis) { return {s[0], s[1], s[2], axis}; }
  bool exists(const std::array<int, 3>& s) const { return s[0] < size_[0] && s[1] < size_[1] && s[2] < size_[2]; }

  void find_crossing(const std::array<int, 3>& s, int axis) {
    const auto other = plus(s, axis);
    if (!exists(other) || (at(s) > 0) == (at(other) > 0)) return;
    positions_[edge(s, axis)] = at(s) / (at(s) - at(other));
    parent_[edge(s, axis)] = edge(s, axis);
  }
  void join(const Edge& a, const Edge& b) {
    const Edge root = representative(b);
    parent_[representative(a)] = root;
  }

  void join_face(const std::array<int, 3>& s, int normal) {
    const int u = (normal + 1) % 3, v = (normal + 2) % 3;
    const auto su = plus(s, u), sv = plus(s, v), suv = plus(su, v);
    if (!exists(suv)) return;
    const Edge bottom = edge(s, u), top = edge(sv, u), left = edge(s, v), right = edge(su, v);
    std::vector<Edge> crossed;
    for (const Edge& e : {bottom, right, top, left}) {
      if (positions_.count(e)) crossed.push_back(e);
    }
    if (crossed.size() == 2) join(crossed[0], crossed[1]);
    if (crossed.size() != 4) return;
    const double g00 = at(s), g10 = at(su), g01 = at(sv), g11 = at(suv);
    const double saddle = (g00 * g11 - g10 * g01) / (g00 + g11 - g10 - g01);
    // With the saddle on the side of (0,0) and (1,1), these two are joined and the other corners cut off.
    const bool joins_diagonal = (saddle > 0) == (g00 > 0);
    join(bottom, joins_diagonal ? right : left);
    join(top, joins_diagonal ? left : right);
  }

  double level_;
  std::array<int, 3> size_;
  std::vector<float> samples_;
  std::map<Edge, double> positions_;
  std::map<Edge, Edge> parent_;
};

/// Compares crossings, positions and the partition into components; returns the number of components.
std::size_t expect_agreement(const Volume& volume, const Isosurface& surface) {
  const LevelSet level_set(surface);
  const BrickField field(volume, level_set);
  const SurfaceComponents found = find_components(field, always_go_on);
  BruteForce expected(volume, level_set);
  EXPECT_EQ(found.of_crossing.size(), expected.positions().size());
  EXPECT_EQ(found.components.size(), expected.components());
  std::map<std::uint32_t, Edge> partner;
  std::vector<SurfaceComponents::Component> extents(found.components.size());
  std::set<Edge> seen;
  const std::uint32_t* component = found.of_crossing.data();
  field.for_each_mixed_brick([&](const std::array<int, 3>& brick) {
    for_each_crossed_edge(field, brick, BrickEdges(field, brick), [&](const CrossedEdge& c) {
      const std::uint32_t number = *component++;
      const Edge e{c.sample[0], c.sample[1], c.sample[2], c.axis};
      EXPECT_TRUE(seen.insert(e).second);
      ASSERT_TRUE(expected.positions().contains(e)) << "an edge that is not crossed";
      const Point3 p = c.point(field.level());
      EXPECT_NEAR(p[c.axis] - c.sample[c.axis], expected.positions().at(e), 1e-12);
      ASSERT_LT(number, found.components.size());
      extents[number].box.extend(p);
      ++extents[number].crossings;
      const auto [entry, is_new] = partner.try_emplace(number, expected.representative(e));
      EXPECT_EQ(entry->second, expected.representative(e));
    });
  });
  for (std::size_t i = 0; i < extents.size(); ++i) {
    EXPECT_EQ(found.components[i].box.min, extents[i].box.min);
    EXPECT_EQ(found.components[i].box.max, extents[i].box.max);
    EXPECT_EQ(found.components[i].crossings, extents[i].crossings);
  }
  return found.components.size();
}

TEST(SurfaceCrossings, AgreeWithBruteForceOnShapes) {
  EXPECT_EQ(expect_agreement(make_phantom("sphere", test::cubic_image(24)), {0, false}), 1u);
  EXPECT_EQ(expect_agreement(make_phantom("shells", test::cubic_image(30)), {0, false}), 3u);
  EXPECT_EQ(expect_agreement(make_phantom("border", test::cubic_image(24)), {0, false}), 1u);
  expect_agreement(make_phantom("gyroid", test::cubic_image(24)), {0, false});
}

TEST(SurfaceCrossings, AgreeWithBruteForceOnNoiseWhereManyFacesAreAmbiguous) {
  PhantomOptions image = test::cubic_image(14);
  image.noise = 1;
  EXPECT_GT(expect_agreement(make_phantom("noisy-sphere", image), {0, false}), 5u);
  image.dims = {11, 17, 9};
  for (double isovalue : {-1.5, 0.2, 1.5}) expect_agreement(make_phantom("noisy-sphere", image), {isovalue, true});
}

TEST(SurfaceCrossings, AgreeWithBruteForceOnTies) {
  PhantomOptions image = test::cubic_image(12);
  for (bool below : {false, true}) {
    for (double isovalue : {1.0, 2.0, 3.0}) expect_agreement(make_phantom("random", image), {isovalue, below});
  }
}

TEST(SurfaceCrossings, EachOfManySeparateVoxelsIsAComponent) {
  VolumeHeader header;
  header.dims = {19, 19, 19};
  std::vector<float> samples(19 * 19 * 19, 0.0f);
  std::size_t count = 0;
  for (int k = 0; k < 19; k += 2) {
    for (int j = 0; j < 19; j += 2) {
      for (int i = 0; i < 19; i += 2, ++count) samples[(k * 19 + j) * 19 + i] = 1;
    }
  }
  EXPECT_EQ(expect_agreement(Volume(header, samples), {0.9, false}), count);
}

}  // namespace
}  // namespace delvox
