#include "meshing/feature_segments.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace delvox {
namespace {

/// Of the size: as seeds.
constexpr double kDensity = 0.9;
/// Lines are straight to this part of the surface's diagonal: what single-precision coordinates are good to.
constexpr double kStraight = 1e-6;
/// What is this little outside a diametral ball counts as inside: a segment whose ball others just touch need not be an
/// edge.
constexpr double kMargin = 1.02;  // of squared radii

/// Cosine of the angle from which on ends encroach on each other only if segments differ much in length.
constexpr double kAcute = 0.05;

double diagonal_of(const FeatureEdges& edges) {
  Box3 box;
  for (const Point3& p : edges.points) box.extend(p);
  return box.diagonal();
}

Vector3 direction(const FeatureLine& line, bool from_last) {
  const Vector3 along = line.points.back() - line.points.front();
  return ((from_last ? -1 : 1) / norm(along)) * along;
}

}  // namespace

FeatureSegments::FeatureSegments(FeatureEdges edges, const SizeField& size, double longest, double shortest,
                                 const GoOn& go_on)
    : edges_(std::move(edges)),
      size_(size),
      longest_(longest),
      shortest_(shortest),
      lines_(feature_lines(edges_, kStraight * diagonal_of(edges_))) {
  std::vector<std::uint32_t> node_of(edges_.points.size(), ~0u);
  const std::vector<std::array<double, 2>> shells = find_shells();
  for (std::uint32_t l = 0; l < lines_.size(); ++l) {
    Edge ends{};
    for (std::size_t i = 0; i < 2; ++i) {
      std::uint32_t& known = node_of[lines_[l].ends[i]];
      if (known == ~0u) known = add_node(edges_.points[lines_[l].ends[i]]);
      ends[i] = known;
    }
    line_ends_.push_back(ends);
    cut_line(l, ends, shells[l], go_on);
  }
  cut_encroached(go_on);
}

const FeatureEdges::Edge& FeatureSegments::edge(std::uint32_t segment) const {
  const Segment& s = segments_[segment];
  return edges_.edges[lines_[s.line].edge(0.5 * (s.from + s.to))];
}

bool FeatureSegments::joined(std::uint32_t node, std::uint32_t other) const {
  const auto& there = at_[node];
  return std::any_of(there.begin(), there.end(),
                     [&](std::uint32_t s) { return ends(s)[0] == other || ends(s)[1] == other; });
}

std::uint32_t FeatureSegments::add_node(const Point3& p) {
  nodes_.push_back(p);
  at_.emplace_back();
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void FeatureSegments::put_into_grid(std::uint32_t segment) {
  grid_.add(segment, middle(segment), 0.5 * kMargin * length(segment));
}

void FeatureSegments::add_segment(std::uint32_t line, Edge ends, double from, double to) {
  const auto segment = segment_count();
  segments_.push_back({ends, line, from, to});
  for (std::uint32_t end : ends) at_[end].push_back(segment);
  put_into_grid(segment);
}

double FeatureSegments::wanted_length(const Point3& p) const { return kDensity * std::min(size_(p), longest_); }

/// How far from each of its ends each line is to be cut, 0 where it need not be: where lines meet at less than a right
/// angle, all at the same distance.
std::vector<std::array<double, 2>> FeatureSegments::find_shells() const {
  std::vector<std::vector<LineEnd>> at(edges_.points.size());
  for (std::uint32_t l = 0; l < lines_.size(); ++l) {
    at[lines_[l].ends[0]].push_back({l, false});
    at[lines_[l].ends[1]].push_back({l, true});
  }
  std::vector<std::array<bool, 2>> acute(lines_.size(), {false, false});
  for (const auto& there : at) {
    bool any = false;
    for (std::size_t i = 0; i < there.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        any |= dot(direction(lines_[there[i].line], there[i].last), direction(lines_[there[j].line], there[j].last)) > kAcute;
      }
    }
    for (const LineEnd& end : there) acute[end.line][end.last] = any;
  }
  std::vector<std::array<double, 2>> shells(lines_.size(), {0, 0});
  for (const auto& there : at) {
    if (there.empty() || !acute[there[0].line][there[0].last]) continue;
    const double shell = shell_at(there, acute);
    for (const LineEnd& end : there) shells[end.line][end.last] = shell;
  }
  return shells;
}

/// The longest that leaves no line with a short rest.
double FeatureSegments::shell_at(const std::vector<LineEnd>& there, const std::vector<std::array<bool, 2>>& acute) const {
  const LineEnd& first = there.front();
  double shell = wanted_length(first.last ? lines_[first.line].points.back() : lines_[first.line].points.front());
  for (const LineEnd& end : there) {
    const bool beyond_too = acute[end.line][!end.last];
    shell = std::min(shell, lines_[end.line].length() / (beyond_too ? 3 : 1));
  }
  bool changed = true;
  for (int round = 0; changed && round < 16; ++round) {
    changed = false;
    for (const LineEnd& end : there) {
      const double length = lines_[end.line].length();
      if (length <= (1 + 1e-9) * shell || length >= 1.5 * shell) continue;
      shell = 0.5 * length;
      changed = true;
    }
  }
  return shell;
}

void FeatureSegments::cut_line(std::uint32_t line, const Edge& ends, const std::array<double, 2>& shells,
                               const GoOn& go_on) {
  const double length = lines_[line].length();
  const double first = shells[0] < (1 - 1e-9) * length ? shells[0] : 0;
  const double last = length - (shells[1] < (1 - 1e-9) * length ? shells[1] : 0);
  Edge inner = ends;
  if (first > 0) {
    inner[0] = add_node(lines_[line].point(first));
    add_segment(line, {ends[0], inner[0]}, 0, first);
  }
  if (last < length) {
    inner[1] = last > first ? add_node(lines_[line].point(last)) : inner[0];
    add_segment(line, {inner[1], ends[1]}, last, length);
  }
  if (inner[0] != inner[1] || (first == 0 && last == length)) cut_piece(line, inner, first, last, go_on);
}

/// Into equal parts, and these again where sizes ask for it. Nothing is left out when go_on() says to end, but the run
/// may be cancelled.
void FeatureSegments::cut_piece(std::uint32_t line, Edge ends, double from, double to, const GoOn& go_on) {
  constexpr int kSamples = 8;
  double wanted = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSamples; ++i) {
    wanted = std::min(wanted, wanted_length(lines_[line].point(from + (to - from) * i / kSamples)));
  }
  const bool constant = size_.constant();
  const double parts = constant ? std::ceil((to - from) / wanted * (1 - 1e-9)) : to - from > wanted ? 2 : 1;
  const auto count = static_cast<std::uint64_t>(std::max(1.0, parts));
  std::uint32_t last = ends[0];
  double last_at = from;
  for (std::uint64_t i = 1; i <= count; ++i) {
    go_on();
    const double at = i == count ? to : from + (to - from) * static_cast<double>(i) / static_cast<double>(count);
    const std::uint32_t node = i == count ? ends[1] : add_node(lines_[line].point(at));
    if (constant || count == 1) {
      add_segment(line, {last, node}, last_at, at);
    } else {
      cut_piece(line, {last, node}, last_at, at, go_on);
    }
    last = node;
    last_at = at;
  }
}

void FeatureSegments::cut_encroached(const GoOn& go_on) {
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    while (const auto segment = encroached_by(nodes_[n], n)) {
      if (!may_split(*segment) || !go_on()) break;
      split(*segment);
    }
  }
}

std::optional<std::uint32_t> FeatureSegments::encroached_by(const Point3& p, std::uint32_t node) const {
  std::optional<std::uint32_t> most;
  double least = kMargin;
  grid_.for_each_near(p, [&](std::uint32_t s) {
    if (ends(s)[0] == node || ends(s)[1] == node) return;
    const double length = distance(nodes_[ends(s)[0]], nodes_[ends(s)[1]]);
    const double share = 4 * squared_distance(p, middle(s)) / (length * length);
    if (share > least || (share == least && (!most || *most < s))) return;
    most = s;
    least = share;
  });
  return most;
}

bool FeatureSegments::may_split(std::uint32_t segment) const {
  constexpr double kFewestParts = 8;
  return length(segment) >= std::min(2 * shortest_, 2 / kFewestParts * lines_[segments_[segment].line].length());
}

std::uint32_t FeatureSegments::split(std::uint32_t segment) {
  grid_.remove(segment, middle(segment), 0.5 * kMargin * length(segment));
  const Segment whole = segments_[segment];
  const double at = 0.5 * (whole.from + whole.to);
  const std::uint32_t node = add_node(lines_[whole.line].point(at));
  segments_[segment] = {{whole.ends[0], node}, whole.line, whole.from, at};
  at_[node].push_back(segment);
  std::erase(at_[whole.ends[1]], segment);
  put_into_grid(segment);
  add_segment(whole.line, {node, whole.ends[1]}, at, whole.to);
  return node;
}

}  // namespace delvox
