#include "verdict.h"

#include "format.h"

namespace delvox::tools {
namespace {

// A run that a limit stopped is marked incomplete, and the check says so: the stop itself is the better message.
bool says_more_than_the_stop(const Check& check) {
  return check.status == CheckStatus::kFailed && check.name != "complete run";
}

std::string describe(const Check& check) {
  std::string text = check.name + ": " + plural(check.violations, "violation");
  if (check.bound && *check.bound != 0) {
    text += ", worst " + number(check.measured) + " against " + number(*check.bound) +
            (check.unit.empty() ? "" : " " + check.unit);
  }
  if (check.where) text += ", at " + point(*check.where);
  return text;
}

std::string mend(const RunReport& run) {
  switch (run.stop) {
    case StopReason::kMaxVertices: return "raise --max-vertices or --size";
    case StopReason::kMaxSeconds: return "raise --max-seconds or --size";
    case StopReason::kFinished: break;
  }
  return "try --smooth, another --size, or see --report";
}

}  // namespace

std::string describe(const Unmet& unmet) {
  std::string text = unmet.criterion;
  if (unmet.where) text += ": " + plural(unmet.count, "place") + ", first near " + point(*unmet.where);
  if (!unmet.reason.empty()) text += " (" + unmet.reason + ")";
  return text;
}

std::optional<Unmet> topology_shortfall(const CheckReport& check, const std::optional<SurfaceTopology>& input,
                                        const std::string& who) {
  const SurfaceTopology mesh{check.statistics.surface_components, check.statistics.euler};
  if (!input || mesh == *input) return std::nullopt;
  return Unmet{"topology", 1, std::nullopt,
               plural(mesh.components, "component") + " and Euler number " + std::to_string(mesh.euler) + ", " + who +
                   " has " + std::to_string(input->components) + " and " + std::to_string(input->euler) +
                   ": parts thinner than the size",
               false};
}

std::string verdict(const RunReport& run, const CheckReport& check, const std::string& advice) {
  std::vector<std::string> faults;
  if (run.stop != StopReason::kFinished) faults.push_back(to_string(run.stop));
  for (const Unmet& unmet : run.unmet) {
    if (unmet.breaks_promise) faults.push_back(describe(unmet));
  }
  for (const Check& c : check.checks) {
    if (says_more_than_the_stop(c)) faults.push_back(describe(c));
  }
  if (faults.empty()) return check.all_hold() && run.succeeded() ? "" : "the run is not complete; see --report";
  std::string text = faults[0];
  if (faults.size() > 1) text += ", and " + plural(faults.size() - 1, "more fault");
  return text + "; " + (advice.empty() ? mend(run) : advice);
}

std::string verdict(const CheckReport& check) {
  if (check.all_hold()) return {};
  std::string text;
  std::size_t more = 0;
  for (const Check& c : check.checks) {
    if (c.status != CheckStatus::kFailed) continue;
    if (text.empty()) {
      text = describe(c);
    } else {
      ++more;
    }
  }
  return more > 0 ? text + ", and " + plural(more, "more fault") : text;
}

std::string advice_on(const Ties& ties) {
  if (ties.count() == 0) return {};
  return plural(ties.count(), "sample") + (ties.count() == 1 ? " equals" : " equal") +
         " the isovalue, which leaves parts of the surface as thin as a rounding error; --iso " +
         number(ties.untied(), 9) + " labels every voxel alike without that";
}

}  // namespace delvox::tools
