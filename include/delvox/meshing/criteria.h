#pragma once

#include <limits>

#include "delvox/core/size_field.h"

namespace delvox {

/// What every surface triangle must meet. Lengths in mm, angles in degrees.
struct SurfaceCriteria {
  SizeField size = 1.0;              ///< upper bound on surface Delaunay ball radii (lambda)
  double min_angle_degrees = 30;     ///< 0 to 30; 30 is radius-edge 1, the Quality step of DelSurf
  double max_deviation = std::numeric_limits<double>::infinity();  ///< circumcentre to surface ball centre
  double max_roughness_degrees = 180;  ///< upper bound on the roughness of edges: pi less the dihedral angle; 180: none
  double min_ball_radius = 0;        ///< TopoDisk and deviation leave balls at or below this radius alone
  double min_smooth_radius = 0;      ///< Smooth and step 4 of DelTetSurf leave balls at or below it, or the above, alone
  double thin_ball_radius = 0;       ///< TopoDisk gives up once balls below it multiply as they halve; 0: never
  double feature_angle_degrees = 180;  ///< edges of the domain between facets whose normals are further apart are kept
  bool topo_disk = true;             ///< false: skip step 3 of DelSurf; the surface need not be manifold
};

/// What every tetrahedron must meet.
struct TetCriteria {
  double radius_edge = 2;            ///< at least 2 (theorem 14.15)
  SizeField cell_size = 1.0;         ///< upper bound on circumradii
  double grade = 0;                  ///< what it grows by per mm of depth, if graded() made it (graded_size.h)
};

}  // namespace delvox
