#include "meshing_sizes.h"

#include <limits>

#include "delvox/core/errors.h"
#include "delvox/meshing/feature_size.h"
#include "format.h"
#include "sizes.h"

namespace delvox::tools {

MeshingSizes decide_sizes(const MeshingOptions& options, const MeshingDomain& domain, const Console& console) {
  MeshingSizes sizes;
  const Frame frame = domain.own_frame();
  if (!options.cell_size.empty()) sizes.cell_size = parse_size(options.cell_size, "--cell-size", frame);
  if (!options.size.empty()) {
    sizes.request.emplace(options.size, frame);
    const std::optional<SizeField> field = sizes.request->field();
    sizes.size = field ? *field : SizeField(domain.default_size());  // which takes a look at every sample
    sizes.sentence = "size " + options.size + (field && sizes.size.constant() ? " mm" : "");
  } else if (options.algorithm == "delsurf1") {
    sizes.request.emplace("lfs", frame);
    sizes.sentence = "size lfs";
  } else if (options.algorithm == "delsurf2") {
    sizes.size = std::numeric_limits<double>::infinity();
    sizes.sentence = "no size: as fine as the topology asks";
  } else if (options.tets == 0) {
    sizes.size = domain.default_size();
    sizes.sentence = "size " + number(sizes.size.maximum()) + " mm, " + domain.origin_of_default_size();
    console.note(sizes.sentence);
  }
  if (options.epsilon && !(sizes.request && sizes.request->of_surface())) {
    throw OptionError("--epsilon: of what? It goes with --size lfs or curvature");
  }
  return sizes;
}

void find_on_surface(MeshingSizes& sizes, const MeshingOptions& options, MeshingDomain& domain, Stopwatch& watch,
                     const Console& console) {
  const bool regular = options.algorithm == "delsurf1" || options.start == "persistent";
  if (!sizes.request || (sizes.request->field() && (!regular || sizes.size.constant()))) return;
  const double spacing = 0.5 * domain.default_size(), epsilon = options.epsilon.value_or(kDefaultEpsilon);
  const auto oracle = domain.make_oracle(domain.default_size(), watch);
  watch.timed("sizes", [&] {
    sizes.size = sizes.request->on(*oracle, spacing, epsilon, domain.frame());
    if (regular && !sizes.request->of_surface()) sizes.size = lipschitz(sizes.size, *oracle, spacing);
    if (!sizes.cell_size && options.grade == 0) {
      sizes.cell_size = sizes.request->cells_on(*oracle, spacing, sizes.size);
    }
  });
  if (sizes.request->of_surface()) sizes.sentence = "size " + number(epsilon) + " * " + sizes.sentence.substr(5);
  sizes.sentence += ", " + number(sizes.size.minimum()) + " to " + number(sizes.size.maximum()) + " mm";
  console.note(sizes.sentence);
}

}  // namespace delvox::tools
