#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// Bounds on the effort of a run; 0 means none. Reaching one ends the run with what there is.
struct RunLimits {
  std::size_t max_vertices = 0;
  double max_seconds = 0;
};

/// A sign of life, sent a few times a second at most.
struct Progress {
  const char* stage = "";   ///< "seeds", "surface", "topology", "interior", "tets", ...
  std::size_t vertices = 0;  ///< in the triangulation so far
  std::size_t waiting = 0;   ///< entries in the queues
};

/// How a caller steers a running algorithm.
struct RunControl {
  RunLimits limits;
  std::function<void(const Progress&)> on_progress;  ///< called from the running thread
  const std::atomic<bool>* cancel = nullptr;          ///< set to true: the run throws Cancelled soon after
};

/// Why a run ended: of itself, or at one of its RunLimits.
enum class StopReason { kFinished, kMaxVertices, kMaxSeconds };
/// "finished", "max-vertices reached" or "max-seconds reached".
const char* to_string(StopReason reason);

/// A criterion that could not be met somewhere, with the first place where.
struct Unmet {
  std::string criterion;  ///< "topology", "deviation", "angle", "radius-edge", ...
  std::size_t count = 0;
  std::optional<Point3> where;  ///< world position of one instance; none if it is a matter of the mesh as a whole
  std::string reason;
  bool breaks_promise = true;  ///< false: counted and reported, but the run still succeeds
};

/// How long a stage took.
struct StageTime {
  std::string stage;
  double seconds = 0;
};

/// What a run did, beside its mesh.
struct RunReport {
  StopReason stop = StopReason::kFinished;
  std::vector<Unmet> unmet;
  std::vector<StageTime> stages;
  std::size_t components = 0;          ///< of the surface, as seeded
  std::size_t surface_insertions = 0;
  std::size_t topology_insertions = 0;
  std::size_t interior_insertions = 0;
  std::size_t smooth_insertions = 0;  ///< of Smooth (book, 14.4)
  std::size_t removals = 0;           ///< step 2 of DelTetSurf, and vertices of persistent triangles
  std::size_t reinsertions = 0;       ///< of vertices of persistent triangles, when refinement was stuck without
  std::size_t dense_insertions = 0;   ///< made without Del S, once the sample was dense
  std::size_t dense_failures = 0;     ///< places for which Del S had to be made again

  bool succeeded() const;
};

}  // namespace delvox
