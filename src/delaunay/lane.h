#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "delaunay/delaunay3.h"
#include "delaunay/surface_balls.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// One of several insertions that are made at a time: evaluated beside each other, then those committed beside each
/// other that have no vertex in common but far corners. Which those are depends on the lanes' claims alone.
struct Lane {
  Star star;
  std::uint32_t claim = 0;      ///< greater than all before
  std::vector<CellId> created;  ///< by the last commit
  std::vector<std::array<VertexId, 3>> lost;  ///< triangles whose balls were dropped since it was last cleared
  Delaunay3::Room room;
  SurfaceBalls::Room balls;
};

/// What a thread needs for itself.
struct Worker {
  explicit Worker(std::unique_ptr<const Oracle> own) : oracle(std::move(own)) {}

  std::unique_ptr<const Oracle> oracle;
  StarSearch search;
  std::vector<CellId> around;  ///< a vertex
};

}  // namespace delvox
