#include "meshing/check_options.h"

#include <cmath>
#include <string>

#include "delvox/core/errors.h"

namespace delvox {

void check_criteria(const SurfaceCriteria& criteria) {
  if (!(criteria.size.minimum() > 0)) throw OptionError("size must be positive");
  if (!(criteria.min_angle_degrees >= 0 && criteria.min_angle_degrees <= 30)) {
    throw OptionError("min-angle " + std::to_string(criteria.min_angle_degrees) +
                      ": refinement ends for 0 to 30 degrees only; choose a value in that range");
  }
  if (!(criteria.max_deviation > 0)) throw OptionError("max-deviation must be positive");
  if (!(criteria.max_roughness_degrees > 0 && criteria.max_roughness_degrees <= 180)) {
    throw OptionError("max-roughness must be above 0 and at most 180 degrees");
  }
  if (!(criteria.feature_angle_degrees > 0 && criteria.feature_angle_degrees <= 180)) {
    throw OptionError("feature-angle must be above 0 and at most 180 degrees");
  }
  if (!(criteria.min_smooth_radius >= 0)) throw OptionError("the smallest radius of Smooth must not be negative");
  if (!(criteria.min_ball_radius >= 0)) throw OptionError("the smallest ball radius must not be negative");
  if (!(criteria.thin_ball_radius >= 0)) throw OptionError("the thin ball radius must not be negative");
}

void refuse_features(const SurfaceCriteria& criteria, const std::string& algorithm) {
  if (criteria.feature_angle_degrees < 180) throw OptionError("feature-angle: sharp edges are not kept by " + algorithm);
}

void check_criteria(const TetCriteria& criteria) {
  if (!(criteria.radius_edge >= 2)) {
    throw OptionError("radius-edge " + std::to_string(criteria.radius_edge) +
                      ": refinement ends for bounds of 2 and more only; choose at least 2");
  }
  if (!(criteria.cell_size.minimum() > 0)) throw OptionError("cell-size must be positive");
  if (!(criteria.grade >= 0)) throw OptionError("grade must not be negative");
}

void check_min_fold(double degrees) {
  if (!(degrees >= 0 && degrees <= 90)) throw OptionError("the bound on folds must be from 0 to 90 degrees");
}

Promises promises_of(const SurfaceCriteria& criteria) {
  Promises promises;
  promises.min_angle_degrees = criteria.min_angle_degrees;
  if (std::isfinite(criteria.size.maximum())) promises.size = criteria.size.maximum();
  if (std::isfinite(criteria.max_deviation)) promises.max_deviation = criteria.max_deviation;
  if (criteria.max_roughness_degrees < 180) promises.max_roughness_degrees = criteria.max_roughness_degrees;
  if (criteria.feature_angle_degrees < 180) promises.feature_angle_degrees = criteria.feature_angle_degrees;
  return promises;
}

Promises promises_of(const SurfaceCriteria& surface, const TetCriteria& tets) {
  Promises promises = promises_of(surface);
  promises.radius_edge = tets.radius_edge;
  promises.cell_size = tets.cell_size.maximum();
  if (tets.grade > 0) promises.grade = tets.grade;
  return promises;
}

void withdraw_unmet(const RunReport& report, Promises& promises) {
  for (const Unmet& unmet : report.unmet) {
    if (unmet.criterion == "deviation") promises.max_deviation.reset();
    if (unmet.criterion == "roughness") promises.max_roughness_degrees.reset();
  }
}

}  // namespace delvox
