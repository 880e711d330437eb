#include "meshing/landmark_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "support/random.h"

namespace delvox {
namespace {

using test::Random;

const Box3 kBox{{-10, -4, 0}, {10, 4, 3}};

/// Points anywhere, with links between near ones.
Landmarks random_landmarks(int count, Random& random) {
  Landmarks landmarks;
  for (int n = 0; n < count; ++n) landmarks.points.push_back(random.in(kBox));
  for (std::uint32_t a = 0; a < landmarks.points.size(); ++a) {
    for (std::uint32_t b = 0; b < a; ++b) {
      if (distance(landmarks.points[a], landmarks.points[b]) < 0.7) landmarks.links.push_back({a, b});
    }
  }
  return landmarks;
}

/// What the longest link spans along each axis.
Vector3 longest_spans(const Landmarks& landmarks) {
  Vector3 longest;
  for (const auto& [a, b] : landmarks.links) {
    const Vector3 link = landmarks.points[a] - landmarks.points[b];
    for (int axis = 0; axis < 3; ++axis) longest[axis] = std::max(longest[axis], std::abs(link[axis]));
  }
  return longest;
}

Box3 random_box(Random& random) {
  Box3 box;
  const Point3 center = random.in({{-14, -8, -4}, {14, 8, 7}});  // also where there are no landmarks
  for (int corner = 0; corner < 2; ++corner) box.extend(center + random.between(0, 2.5) * random.direction());
  return box;
}

std::vector<std::uint32_t> numbers_of(const std::vector<LandmarkWatch::Due>& due) {
  std::vector<std::uint32_t> numbers;
  for (const LandmarkWatch::Due& d : due) numbers.push_back(d.landmark);
  return numbers;
}

/// Ends of the links, by their places.
std::multiset<std::array<double, 6>> placed_links(const Landmarks& landmarks) {
  std::multiset<std::array<double, 6>> links;
  for (const auto& [a, b] : landmarks.links) {
    const Point3 &p = landmarks.points[a], &q = landmarks.points[b];
    links.insert({p.x, p.y, p.z, q.x, q.y, q.z});
  }
  return links;
}

double length_of_path(const std::vector<Point3>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += distance(points[i - 1], points[i]);
  return length;
}

TEST(AlongCurve, IsAShortPathThroughTheSameLandmarksWithTheSameLinks) {
  Random random(5);
  const Landmarks landmarks = random_landmarks(2000, random), sorted = along_curve(landmarks);
  EXPECT_EQ(placed_links(sorted), placed_links(landmarks));
  ASSERT_EQ(sorted.points.size(), landmarks.points.size());
  EXPECT_LT(length_of_path(sorted.points), 0.1 * length_of_path(landmarks.points));
  for (std::size_t i = 1; i < sorted.links.size(); ++i) {
    EXPECT_LE(std::min(sorted.links[i - 1][0], sorted.links[i - 1][1]), std::min(sorted.links[i][0], sorted.links[i][1]));
  }
  EXPECT_TRUE(along_curve({}).points.empty());
}

TEST(LandmarkWatch, AllAreDueAtFirstAndThenNone) {
  Random random(1);
  LandmarkWatch watch(random_landmarks(200, random));
  EXPECT_EQ(watch.size(), 200u);
  watch.note_change(kBox, 7);  // before the first look all are due anyway
  const auto due = watch.take_due();
  ASSERT_EQ(due.size(), 200u);
  for (std::uint32_t i = 0; i < due.size(); ++i) {
    EXPECT_EQ(due[i].landmark, i);
    EXPECT_EQ(due[i].near, kNone);
  }
  EXPECT_TRUE(watch.take_due().empty());
}

TEST(LandmarkWatch, ThoseWithinALinkOfAChangeAreDueOnceInOrderWithTheVertexOfTheFirstChange) {
  Random random(2);
  const Landmarks landmarks = random_landmarks(400, random);
  const Vector3 margin = longest_spans(landmarks);
  LandmarkWatch watch(landmarks);
  watch.take_due();
  std::size_t met = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<Box3> boxes;
    const bool many = round % 40 == 39;  // for several threads
    const auto changes = static_cast<VertexId>(many ? 1000 : random.below(4));
    for (VertexId change = 0; change < changes; ++change) {
      boxes.push_back(random_box(random));
      watch.note_change(boxes.back(), 100 + change);
    }
    std::vector<std::uint32_t> expected;
    std::vector<VertexId> near;
    for (std::uint32_t i = 0; i < landmarks.points.size(); ++i) {
      const auto first = std::find_if(boxes.begin(), boxes.end(), [&](const Box3& box) {
        return Box3{box.min - margin, box.max + margin}.contains(landmarks.points[i]);
      });
      if (first == boxes.end()) continue;
      expected.push_back(i);
      near.push_back(100 + static_cast<VertexId>(first - boxes.begin()));
    }
    const auto due = watch.take_due();
    ASSERT_EQ(numbers_of(due), expected);
    for (std::size_t i = 0; i < due.size(); ++i) EXPECT_EQ(due[i].near, near[i]);
    met += due.size();
    EXPECT_TRUE(watch.take_due().empty());
  }
  EXPECT_GT(met, 300u);
}

TEST(LandmarkWatch, LinksOfAwaitedLandmarksComeOnceHoweverOftenTheyAreAwaited) {
  Random random(3);
  const Landmarks landmarks = random_landmarks(300, random);
  ASSERT_GT(landmarks.links.size(), 100u);
  LandmarkWatch watch(landmarks);
  EXPECT_TRUE(watch.take_links().empty());
  for (int round = 0; round < 20; ++round) {
    std::set<std::uint32_t> awaited, expected;
    for (int call = 0; call < 3; ++call) {
      std::vector<LandmarkWatch::Due> due;
      for (int n = 0; n < 30; ++n) due.push_back({static_cast<std::uint32_t>(random.below(300)), kNone});
      watch.await_links_of(due);
      for (std::uint32_t i : numbers_of(due)) awaited.insert(i);
    }
    for (std::uint32_t link = 0; link < landmarks.links.size(); ++link) {
      EXPECT_EQ(watch.link(link), landmarks.links[link]);
      if (awaited.contains(landmarks.links[link][0]) || awaited.contains(landmarks.links[link][1]))
        expected.insert(link);
    }
    std::vector<std::uint32_t> links = watch.take_links();
    std::sort(links.begin(), links.end());
    EXPECT_EQ(links, std::vector<std::uint32_t>(expected.begin(), expected.end()));
    EXPECT_TRUE(watch.take_links().empty());
  }
}

TEST(LandmarkWatch, WorksForNoneForOneAndForManyInOnePlace) {
  LandmarkWatch none;
  EXPECT_TRUE(none.empty());
  EXPECT_TRUE(none.take_due().empty());
  none.note_change(kBox, 1);
  EXPECT_TRUE(none.take_due().empty());
  EXPECT_TRUE(LandmarkWatch(Landmarks{}).empty());
  for (const std::size_t count : {1, 50}) {
    LandmarkWatch watch(Landmarks{std::vector<Point3>(count, Point3{1, 2, 3}), {}});
    EXPECT_EQ(watch.take_due().size(), count);
    watch.note_change({{1, 2, 3}, {1, 2, 3}}, 5);
    EXPECT_EQ(watch.take_due().size(), count);
    watch.note_change({{1.001, 2, 3}, {4, 4, 4}}, 5);  // no links: nothing reaches farther than the change
    EXPECT_TRUE(watch.take_due().empty());
  }
}

}  // namespace
}  // namespace delvox
