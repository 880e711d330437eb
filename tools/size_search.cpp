#include "size_search.h"

#include <algorithm>
#include <cmath>

#include "format.h"

namespace delvox::tools {
namespace {

constexpr int kMostTries = 8;
constexpr double kTolerance = 0.03;
constexpr double kLargestStep = 4;         // beyond it, no extrapolation is worth its run
constexpr double kNarrowestBracket = 1.01;  // three percent in tets

struct Try {
  double size = 0;
  std::size_t tets = 0;
  double excess = 0;  // logarithm of tets / wanted: negative if there are too few
};

class Search {
 public:
  Search(std::size_t wanted, double first_size) : wanted_(static_cast<double>(wanted)), size_(first_size) {}

  // Runs until note() says so.
  SizeSearch run(const std::function<std::optional<std::size_t>(double)>& mesh_at) {
    while (!result_) {
      const std::optional<std::size_t> tets = mesh_at(size_);
      ++tries_;
      note({size_, tets.value_or(0), excess(tets.value_or(0))}, !tets);
    }
    return *result_;
  }

 private:
  double excess(std::size_t tets) const { return std::log(std::max(static_cast<double>(tets), 0.5) / wanted_); }

  void note(const Try& now, bool stopped) {
    if (stopped || tries_ == 1 || std::abs(now.excess) < std::abs(best_.excess)) best_ = now;
    (now.excess > 0 ? too_many_ : too_few_) = now;
    if (stopped) return end(SearchEnd::kStopped);
    if (std::abs(now.excess) <= kTolerance) return end(SearchEnd::kFound);
    if (tries_ == kMostTries) return end(SearchEnd::kOutOfTries);
    if (too_many_ && too_few_) {
      if (too_few_->size < kNarrowestBracket * too_many_->size) return end(SearchEnd::kJump);
      size_ = between(*too_many_, *too_few_, now);
    } else {
      if (last_ && is_floor(*last_, now)) return end(SearchEnd::kFloor);
      size_ = beyond(now);
    }
    last_ = now;
  }

  // A size between two, by the straight line through their logarithms; in the middle if that has nothing to go by, or
  // left the same end alone twice.
  double between(const Try& many, const Try& few, const Try& now) const {
    const bool same_end = last_ && (last_->excess > 0) == (now.excess > 0);
    double part = 0.5;
    if (few.tets > 0 && !same_end) part = std::clamp(many.excess / (many.excess - few.excess), 0.1, 0.9);
    return many.size * std::pow(few.size / many.size, part);
  }

  // The next size where all tries lie to one side: by the secant, kept near the cube law, since counts jump a little.
  double beyond(const Try& now) const {
    if (now.tets == 0) return now.size / 2;
    double exponent = 3;
    if (last_ && last_->tets > 0) {
      exponent = std::clamp((now.excess - last_->excess) / std::log(last_->size / now.size), 1.5, 4.0);
    }
    return now.size * std::clamp(std::exp(now.excess / exponent), 1 / kLargestStep, kLargestStep);
  }

  // Half as large again and hardly fewer: larger sizes change nothing.
  bool is_floor(const Try& before, const Try& now) const {
    return now.size >= 1.5 * before.size && now.excess > std::log(1.25) && now.excess > before.excess + std::log(0.85);
  }

  void end(SearchEnd how) { result_ = {best_.size, best_.tets, tries_, how}; }

  double wanted_, size_;
  int tries_ = 0;
  Try best_;
  std::optional<Try> last_, too_many_, too_few_;
  std::optional<SizeSearch> result_;
};

}  // namespace

SizeSearch find_size(std::size_t wanted, double first_size,
                     const std::function<std::optional<std::size_t>(double size)>& mesh_at) {
  return Search(wanted, first_size).run(mesh_at);
}

std::string describe(const SizeSearch& search, std::size_t wanted) {
  const std::string size = "size " + number(search.size, 6) + " mm, ", tets = plural(wanted, "tet");
  const std::string closest = size + "the closest of " + plural(static_cast<std::size_t>(search.tries), "run");
  switch (search.end) {
    case SearchEnd::kFound:
      return size + "found in " + plural(static_cast<std::size_t>(search.tries), "run") + " for " + tets;
    case SearchEnd::kFloor:
      return closest + ": no size gives " + tets + ", since parts thinner than that take " + grouped(search.tets) +
             " whatever the size; try --smooth, or a larger --min-component";
    case SearchEnd::kJump:
      return closest + ": no size gives " + tets +
             ", since the number jumps there as components pass --min-component; give that a value";
    case SearchEnd::kOutOfTries: return closest + " for " + tets;
    case SearchEnd::kStopped: break;
  }
  return size + "where a limit ended the search for " + tets;
}

}  // namespace delvox::tools
