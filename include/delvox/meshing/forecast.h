#pragma once

#include "delvox/meshing/criteria.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// What a run is expected to give and to take.
struct Estimate {
  double vertices = 0, triangles = 0;
  double tets = 0;     ///< none for surfaces
  double seconds = 0;  ///< of meshing, checking and writing VTU on one core of the machine that the README names
  double bytes = 0;    ///< that these add to what the process holds before, at their peak
};

/// An estimate before meshing, from nothing but the area of the surface, the volume that it encloses, and the sizes.
struct Forecast {
  Estimate least;  ///< if the surface is as smooth and its parts are as thick as the sizes ask for
  /// With what parts thinner than the size take that topology has refined; as `least` if there are few.
  Estimate likely;

  /// Whether thin parts make a difference: then `likely` is a guess at the order of magnitude.
  bool thin() const { return likely.vertices > 1.25 * least.vertices; }
};

/// For delsurf(). All zero if the oracle knows no patches.
Forecast forecast_surface(const Oracle& oracle, const SurfaceCriteria& criteria);

/// For deltetsurf(). All zero if the oracle knows no patches.
Forecast forecast_tets(const Oracle& oracle, const SurfaceCriteria& surface, const TetCriteria& tets);

}  // namespace delvox
