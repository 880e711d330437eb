#include "delvox/meshing/forecast.h"

#include "meshing/size_integrals.h"

namespace delvox {
namespace {

// Fitted to 93 runs on phantoms, a skull, a liver, a head MR and four CTs at 0.3 to 40 voxels per size; numbers of
// elements to 111 later ones, since seeds lie as far apart as the size.
struct Cost {
  double surface = 0;  ///< per SizeIntegrals::surface
  double graded = 0;   ///< per SizeIntegrals::graded
  double volume = 0;   ///< per SizeIntegrals::volume
  double deep = 0;     ///< per SizeIntegrals::deep, on top of that
  double thin = 0;     ///< per SizeIntegrals::surface that only thickness asks for: topology works facet by facet
  double samples = 0;  ///< per MeasuredDomain::samples: finding components and seeds
  double constant = 0;

  double of(const SizeIntegrals& sizes, const MeasuredDomain& domain) const {
    return surface * sizes.surface + graded * sizes.graded + volume * sizes.volume + deep * sizes.deep +
           thin * (sizes.surface - domain.wanted.surface) + samples * domain.samples + constant;
  }
};

struct Costs {
  Cost vertices, triangles, tets, seconds, bytes;
};

constexpr Costs kSurfaceCosts{
    .vertices = {.surface = 0.72},
    .triangles = {.surface = 1.44},
    .tets = {},
    .seconds = {.surface = 6e-6, .thin = 9e-6, .samples = 0.07e-6},
    .bytes = {.surface = 640, .samples = 13, .constant = 1e6},
};
// With an interior lattice, most of which goes in without insertion.
constexpr Costs kTetCosts{
    .vertices = {.surface = 0.51, .graded = 0.25, .volume = 0.66},
    .triangles = {.surface = 1.68, .graded = -0.48},
    .tets = {.surface = 0.6, .graded = 2, .volume = 4},
    .seconds =
        {.surface = 8e-6, .graded = 2.8e-6, .volume = 2.6e-6, .deep = -1e-6, .thin = 12e-6, .samples = 0.15e-6},
    .bytes = {.surface = 510, .graded = 365, .volume = 420, .samples = 27},
};
// Without, where the cell size varies.
constexpr Costs kVaryingTetCosts{
    .vertices = {.surface = 0.51, .graded = 0.25, .volume = 0.75},
    .triangles = {.surface = 1.68, .graded = -0.48},
    .tets = {.surface = 0.6, .graded = 2, .volume = 4.75},
    .seconds = {.surface = 13e-6, .graded = 5e-6, .volume = 7e-6, .thin = 20e-6, .samples = 0.2e-6},
    .bytes = {.surface = 510, .graded = 365, .volume = 620, .samples = 27},
};

Estimate estimate(const Costs& costs, const SizeIntegrals& sizes, const MeasuredDomain& domain) {
  return {.vertices = costs.vertices.of(sizes, domain),
          .triangles = costs.triangles.of(sizes, domain),
          .tets = costs.tets.of(sizes, domain),
          .seconds = costs.seconds.of(sizes, domain),
          .bytes = costs.bytes.of(sizes, domain)};
}

Forecast forecast(const Costs& costs, const MeasuredDomain& domain) {
  if (domain.wanted.surface == 0) return {};  // not where sizes too small for numbers make it infinite or none at all
  const Forecast both{estimate(costs, domain.wanted, domain), estimate(costs, domain.resolved, domain)};
  // Sums over cubes are not exactly those over patches.
  return both.thin() ? both : Forecast{both.least, both.least};
}

}  // namespace

Forecast forecast_surface(const Oracle& oracle, const SurfaceCriteria& criteria) {
  return forecast(kSurfaceCosts, measure_domain(oracle, criteria.size, nullptr));
}

Forecast forecast_tets(const Oracle& oracle, const SurfaceCriteria& surface, const TetCriteria& tets) {
  const Costs& costs = tets.cell_size.constant() ? kTetCosts : kVaryingTetCosts;
  return forecast(costs, measure_domain(oracle, surface.size, &tets));
}

}  // namespace delvox
