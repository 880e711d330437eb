#pragma once

#include "delvox/volume/phantom.h"

namespace delvox {

/// Lengths that the shapes are built from, derived from the options.
struct PhantomSetting {
  const PhantomOptions& options;
  double half_extent;    // mm, half of the image's shortest edge
  double largest_voxel;  // mm

  explicit PhantomSetting(const PhantomOptions& phantom_options);
};

PhantomTruth sphere_truth(const PhantomSetting& setting);
PhantomTruth oblique_sphere_truth(const PhantomSetting& setting);
PhantomTruth noisy_sphere_truth(const PhantomSetting& setting);
PhantomTruth border_truth(const PhantomSetting& setting);
PhantomTruth ellipsoid_truth(const PhantomSetting& setting);
PhantomTruth torus_truth(const PhantomSetting& setting);
PhantomTruth shells_truth(const PhantomSetting& setting);
PhantomTruth touching_balls_truth(const PhantomSetting& setting);
PhantomTruth plate_truth(const PhantomSetting& setting);
PhantomTruth rod_truth(const PhantomSetting& setting);
PhantomTruth gyroid_truth(const PhantomSetting& setting);
PhantomTruth ramp_truth(const PhantomSetting& setting);
PhantomTruth random_truth(const PhantomSetting& setting);
PhantomTruth shepp_logan_truth(const PhantomSetting& setting);

}  // namespace delvox
