#pragma once

#include <string_view>

#include "delvox/oracle/implicit_oracle.h"
#include "delvox/oracle/isosurface_oracle.h"
#include "delvox/volume/phantom.h"

namespace delvox::test {

/// n^3 voxels of 1 mm around the origin.
inline PhantomOptions cubic_image(int n) {
  PhantomOptions options;
  options.dims = {n, n, n};
  return options;
}

/// An oblique, anisotropic image with its middle away from the origin, about 35 mm wide each way.
inline PhantomOptions oblique_image() {
  PhantomOptions options = phantom_defaults("oblique-sphere");
  options.dims = {50, 39, 22};
  return options;
}

/// The function that a phantom samples, as an implicit function with the phantom's image as its box.
inline ImplicitFunction implicit_phantom(std::string_view kind, const PhantomOptions& options, double resolution) {
  const PhantomTruth truth = phantom_truth(kind, options);
  ImplicitFunction function;
  function.value = [truth](const Point3& p) { return truth.isovalue - truth.value(p); };
  function.gradient = [truth](const Point3& p) { return -1.0 * truth.gradient(p); };
  for (int corner = 0; corner < 8; ++corner) {
    Point3 p = options.center;
    for (int axis = 0; axis < 3; ++axis) {
      const double half = 0.5 * options.dims[axis] * options.spacing[axis];
      p = p + (corner >> axis & 1 ? half : -half) * options.direction[axis];
    }
    function.box.extend(p);
  }
  function.resolution = resolution;
  return function;
}

inline std::unique_ptr<SmoothOracle> implicit_phantom_oracle(std::string_view kind, const PhantomOptions& options,
                                                             double resolution) {
  return make_implicit_oracle(implicit_phantom(kind, options, resolution));
}

inline std::unique_ptr<SmoothOracle> voxel_phantom_oracle(std::string_view kind, const PhantomOptions& options) {
  return make_isosurface_oracle(make_phantom(kind, options), {phantom_truth(kind, options).isovalue, false});
}

/// The ball of radius 1 around the origin.
inline std::unique_ptr<SmoothOracle> unit_ball() {
  ImplicitFunction ball;
  ball.value = [](const Point3& p) { return norm(p) - 1; };
  ball.gradient = [](const Point3& p) { return (1 / norm(p)) * p; };
  ball.box = {{-1.2, -1.2, -1.2}, {1.2, 1.2, 1.2}};
  ball.resolution = 0.1;
  return make_implicit_oracle(ball);
}

}  // namespace delvox::test
