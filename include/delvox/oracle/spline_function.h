#pragma once

#include "delvox/oracle/smooth_function.h"
#include "delvox/volume/level_set.h"

namespace delvox {

/// Volumes of more samples than that along an axis are refused: critical points take too long.
inline constexpr int kMostSplineSamples = 32;

/// The isosurface of a volume under the quintic B-spline that interpolates its samples, tensor-product and four times
/// continuously differentiable, as DelSurf2 asks (book, theorem 14.7). Its axes are those of the image, the first
/// sample of which is at the origin; beyond its border come some layers of what level_set.h pads it with, so that the
/// surface closes there. Enclosures over boxes are exact to rounding but for what lies between Bernstein coefficients
/// and the polynomial they bound. Sources: Unser, Splines: a perfect fit for signal and image processing (1999);
/// Ramshaw, Blossoms are polar forms (1989). Throws OptionError if the volume has more than kMostSplineSamples along an
/// axis, or if its axes are not orthogonal.
SmoothDomain make_spline_domain(const Volume& volume, const Isosurface& surface);

}  // namespace delvox
