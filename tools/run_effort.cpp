#include "run_effort.h"

#include <algorithm>

#include "format.h"

namespace delvox::tools {

void tell_effort(const Console& console, const RunReport& run, const std::optional<SliverReport>& slivers) {
  for (const StageTime& stage : run.stages) {
    console.detail("stage " + stage.stage + ": " + number(stage.seconds, 3) + " s");
  }
  console.detail("inserted: surface " + grouped(run.surface_insertions) + ", topology " +
                 grouped(run.topology_insertions) + ", smooth " + grouped(run.smooth_insertions) + ", interior " +
                 grouped(run.interior_insertions) + "; removed " + grouped(run.removals));
  if (!slivers) return;
  console.detail("slivers " + grouped(slivers->slivers) + ": reconnected " + grouped(slivers->reconnections) +
                 ", moved " + grouped(slivers->moves) + ", inserted " + grouped(slivers->insertions) + ", removed " +
                 grouped(slivers->removals) + ", left " + grouped(slivers->unmet.size()));
}

void tell_dense(const Console& console, const RunReport& run) {
  if (run.dense_insertions == 0) {
    return console.note("nothing was inserted on the surface alone: the sample is not dense where it is to be refined");
  }
  std::string text = "inserted beside the seeds: " + grouped(run.surface_insertions + run.topology_insertions) +
                     " in the triangulation of space, " + grouped(run.dense_insertions) + " on the surface alone";
  if (run.dense_failures > 0) {
    text += "; for " + plural(run.dense_failures, "place") + " the triangulation of space was made again";
  }
  console.note(text);
}

void warn_of_slivers(const Console& console, const SliverReport& slivers) {
  constexpr std::size_t kListed = 20;
  const auto& unmet = slivers.unmet;
  for (std::size_t i = 0; i < std::min(kListed, unmet.size()); ++i) {
    console.note("warning: a dihedral angle of " + number(unmet[i].dihedral_degrees, 3) + " degrees at " +
                 point(unmet[i].where) + ": " + unmet[i].reason);
  }
  if (unmet.size() > kListed) console.note("... and " + grouped(unmet.size() - kListed) + " more, see --report");
}

}  // namespace delvox::tools
