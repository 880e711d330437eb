#include "delvox/meshing/image_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/parallel.h"
#include "delvox/core/errors.h"

namespace delvox {
namespace {

constexpr std::size_t kChunk = 256;     // tets
constexpr int kDeepest = 3;             // halvings of a tet's edges
constexpr double kVoxelsPerPiece = 2;   // edge of a piece of the quadrature
constexpr double kLeastDensity = 0.01;  // g/cm3: about that of air in lungs, so that no modulus is 0

using Barycentric = std::array<double, 4>;

Barycentric middle(const Barycentric& a, const Barycentric& b) {
  Barycentric m;
  for (std::size_t i = 0; i < 4; ++i) m[i] = 0.5 * (a[i] + b[i]);
  return m;
}

/// Appends the four Gauss points of each of the 8^depth pieces of equal volume.
void add_points(const std::array<Barycentric, 4>& c, int depth, std::vector<Barycentric>& points) {
  if (depth == 0) {
    constexpr double kNear = 0.58541019662496852, kFar = 0.1381966011250105;
    for (std::size_t g = 0; g < 4; ++g) {
      Barycentric p{};
      for (std::size_t corner = 0; corner < 4; ++corner) {
        for (std::size_t i = 0; i < 4; ++i) p[i] += (corner == g ? kNear : kFar) * c[corner][i];
      }
      points.push_back(p);
    }
    return;
  }
  const Barycentric m01 = middle(c[0], c[1]), m02 = middle(c[0], c[2]), m03 = middle(c[0], c[3]);
  const Barycentric m12 = middle(c[1], c[2]), m13 = middle(c[1], c[3]), m23 = middle(c[2], c[3]);
  const std::array<Barycentric, 4> pieces[8] = {{c[0], m01, m02, m03}, {m01, c[1], m12, m13}, {m02, m12, c[2], m23},
                                                {m03, m13, m23, c[3]}, {m01, m02, m03, m13},  {m01, m02, m12, m13},
                                                {m02, m03, m13, m23},  {m02, m12, m13, m23}};
  for (const auto& piece : pieces) add_points(piece, depth - 1, points);
}

std::vector<std::vector<Barycentric>> quadratures() {
  std::vector<std::vector<Barycentric>> result(kDeepest + 1);
  for (int depth = 0; depth <= kDeepest; ++depth) {
    add_points({{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}, depth,
               result[static_cast<std::size_t>(depth)]);
  }
  return result;
}

/// The samples around one tet, read at once.
class Block {
 public:
  explicit Block(const Volume& volume) : volume_(volume) {}
  /// Loads what the box, in index coordinates, needs.
  void load(const Box3& box) {
    std::size_t count = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const int last = volume_.dims()[a] - 1;
      begin_[a] = std::clamp(static_cast<int>(std::floor(box.min[axis])), 0, last);
      size_[a] = std::clamp(static_cast<int>(std::floor(box.max[axis])) + 1, begin_[a], last) - begin_[a] + 1;
      count *= static_cast<std::size_t>(size_[a]);
    }
    samples_.resize(count);
    volume_.copy_block(begin_, size_, samples_.data());
  }
  double operator()(const Point3& index) const {
    std::size_t low[3], high[3];
    double t[3];
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double at = std::clamp(index[axis] - begin_[a], 0.0, static_cast<double>(size_[a] - 1));
      low[axis] = static_cast<std::size_t>(at);
      high[axis] = std::min(low[axis] + 1, static_cast<std::size_t>(size_[a] - 1));
      t[axis] = at - static_cast<double>(low[axis]);
    }
    double value = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      std::size_t at[3];
      for (int axis = 0; axis < 3; ++axis) {
        const bool up = (corner >> axis & 1) != 0;
        weight *= up ? t[axis] : 1 - t[axis];
        at[axis] = up ? high[axis] : low[axis];
      }
      const auto nx = static_cast<std::size_t>(size_[0]), ny = static_cast<std::size_t>(size_[1]);
      value += weight * static_cast<double>(samples_[(at[2] * ny + at[1]) * nx + at[0]]);
    }
    return value;
  }

 private:
  const Volume& volume_;
  std::array<int, 3> begin_{}, size_{};
  std::vector<float> samples_;
};

/// Means over one tet, and its volume.
struct TetMean {
  double modulus = 0, density = 0, thin = 0, volume_mm3 = 0;
};

class Averager {
 public:
  Averager(const TetMesh& mesh, const Volume& volume, const ImageMaterialOptions& options)
      : mesh_(mesh), volume_(volume), options_(options), to_index_(volume.header().index_to_world.inverse()) {}

  std::vector<TetMean> run() const {
    std::vector<TetMean> means(mesh_.tets.size());
    for_each_chunk(means.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      Block block(volume_);
      for (std::size_t t = begin; t < end; ++t) means[t] = mean_of(mesh_.tets[t], block);
    });
    return means;
  }

 private:
  TetMean mean_of(const Tet& tet, Block& block) const {
    Point3 corners[4];
    Box3 box;
    for (std::size_t i = 0; i < 4; ++i) {
      corners[i] = to_index_(mesh_.points[tet[i]]);
      box.extend(corners[i]);
    }
    block.load(box);
    double longest = 0;
    for (const auto& edge : kTetEdges) longest = std::max(longest, distance(corners[edge[0]], corners[edge[1]]));
    int depth = 0;
    while (depth < kDeepest && longest > kVoxelsPerPiece * (1 << depth)) ++depth;
    const std::vector<Barycentric>& points = quadratures_[static_cast<std::size_t>(depth)];
    TetMean mean;
    for (const Barycentric& b : points) {
      Point3 at;
      for (std::size_t i = 0; i < 4; ++i) at = at + b[i] * corners[i];
      double density = options_.density_offset + options_.density_slope * block(at);
      if (density < kLeastDensity) {
        density = kLeastDensity;
        mean.thin += 1;
      }
      mean.density += density;
      mean.modulus += options_.law.modulus_mpa(density);
    }
    const double share = 1 / static_cast<double>(points.size());
    const Point3 p = mesh_.points[tet[0]];
    const double six = dot(cross(mesh_.points[tet[1]] - p, mesh_.points[tet[2]] - p), mesh_.points[tet[3]] - p);
    return {share * mean.modulus, share * mean.density, share * mean.thin, six / 6};
  }

  const TetMesh& mesh_;
  const Volume& volume_;
  const ImageMaterialOptions& options_;
  const Affine3 to_index_;
  const std::vector<std::vector<Barycentric>> quadratures_ = quadratures();
};

struct Bin {
  double modulus = 0, density = 0, volume = 0;  ///< sums over the volume
  Label region = 0;
};

std::string bin_name(Label region) {
  return (region < 10 ? "bin_0" : "bin_") + std::to_string(region);
}

}  // namespace

ImageMaterialReport assign_image_materials(TetMesh& mesh, const Volume& volume, const ImageMaterialOptions& options) {
  const std::vector<TetMean> means = Averager(mesh, volume, options).run();
  ImageMaterialReport report;
  mesh.materials.clear();
  mesh.regions.assign(mesh.tets.size(), 1);
  if (means.empty()) return report;
  const auto [least, greatest] = std::minmax_element(
      means.begin(), means.end(), [](const TetMean& a, const TetMean& b) { return a.modulus < b.modulus; });
  if (!std::all_of(means.begin(), means.end(), [](const TetMean& mean) {
        return std::isfinite(mean.modulus) && mean.modulus > 0 && std::isfinite(mean.density);
      })) {
    throw OptionError("materials from the image: a modulus comes out as infinite or zero; check --hu-density and --modulus");
  }
  report.least_mpa = least->modulus;
  report.greatest_mpa = greatest->modulus;
  const double width = (report.greatest_mpa - report.least_mpa) / static_cast<double>(options.bins);
  const auto bin_of = [&](const TetMean& mean) {
    if (!(width > 0)) return std::size_t{0};
    return std::min(static_cast<std::size_t>((mean.modulus - report.least_mpa) / width), options.bins - 1);
  };
  std::vector<Bin> bins(options.bins);
  double total = 0;
  for (const TetMean& mean : means) {
    Bin& bin = bins[bin_of(mean)];
    bin.modulus += mean.volume_mm3 * mean.modulus;
    bin.density += mean.volume_mm3 * mean.density;
    bin.volume += mean.volume_mm3;
    report.mean_mpa += mean.volume_mm3 * mean.modulus;
    report.thin_share += mean.volume_mm3 * mean.thin;
    total += mean.volume_mm3;
  }
  report.mean_mpa /= total;
  report.thin_share /= total;
  constexpr double kKgPerM3 = 1000;  // in a g/cm3
  for (Bin& bin : bins) {
    if (!(bin.volume > 0)) continue;
    bin.region = static_cast<Label>(mesh.materials.size() + 1);
    mesh.materials.push_back({bin_name(bin.region), bin.region, bin.modulus / bin.volume, options.poisson_ratio,
                              kKgPerM3 * bin.density / bin.volume});
  }
  for (std::size_t t = 0; t < means.size(); ++t) mesh.regions[t] = bins[bin_of(means[t])].region;
  return report;
}

}  // namespace delvox
