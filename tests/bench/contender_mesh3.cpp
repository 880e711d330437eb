#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Image_3.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_3/initialize_triangulation_from_gray_image.h>
#include <CGAL/Mesh_3/initialize_triangulation_from_labeled_image.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/refine_mesh_3.h>

#include <stdexcept>
#include <unordered_map>

#include "contender.h"

namespace delvox::bench {

namespace {

namespace params = CGAL::parameters;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;

/// Image_3 places its first sample at the origin; ours, with the padding, lies one sample before it.
Point3 from_cgal(const Kernel::Point_3& p, const Vector3& spacing) {
  return Point3{p.x(), p.y(), p.z()} - spacing;
}

CGAL::Image_3 to_cgal(BenchImage& image) {
  _image* raw = _initImage();
  raw->xdim = image.size[0], raw->ydim = image.size[1], raw->zdim = image.size[2];
  raw->vdim = 1;
  raw->vx = image.spacing.x, raw->vy = image.spacing.y, raw->vz = image.spacing.z;
  raw->wdim = sizeof(float);
  raw->wordKind = WK_FLOAT;
  raw->sign = SGN_SIGNED;
  raw->vectMode = VM_SCALAR;
  raw->data = image.samples.data();
  return CGAL::Image_3(raw, CGAL::Image_3::DO_NOT_OWN_THE_DATA);
}

double outside_value(const BenchImage& image) {
  return image.level - std::abs(image.level) - 1;
}

/// The same trilinear function as the image domain evaluates, by code that spares its divisions.
struct Labelling {
  const BenchImage* image;
  Vector3 scale;

  explicit Labelling(const BenchImage& source)
      : image(&source), scale{1 / source.spacing.x, 1 / source.spacing.y, 1 / source.spacing.z} {}

  int operator()(const Kernel::Point_3& p) const {
    const double x = p.x() * scale.x, y = p.y() * scale.y, z = p.z() * scale.z;
    const auto& n = image->size;
    if (!(x >= 0 && y >= 0 && z >= 0 && x < n[0] - 1 && y < n[1] - 1 && z < n[2] - 1)) return 0;
    const int i = static_cast<int>(x), j = static_cast<int>(y), k = static_cast<int>(z);
    const double u = x - i, v = y - j, w = z - k;
    const std::size_t row = n[0], slice = row * n[1];
    const float* s = image->samples.data() + k * slice + j * row + i;
    const auto along_x = [u](const float* q) { return q[0] + u * (static_cast<double>(q[1]) - q[0]); };
    const auto along_y = [&](const float* q) { return along_x(q) + v * (along_x(q + row) - along_x(q)); };
    const double low = along_y(s), high = along_y(s + slice);
    return low + w * (high - low) > image->level ? 1 : 0;
  }
};

Domain make_domain(const BenchImage& image, const CGAL::Image_3& cgal_image, const Mesh3Choices& choices) {
  if (choices.function_domain) {
    return Domain(Labelling(image), CGAL::Mesh_3::internal::compute_bounding_box(cgal_image),
                  params::relative_error_bound = choices.error_bound);
  }
  return Domain::create_gray_image_mesh_domain(cgal_image, params::iso_value = image.level,
                                               params::value_outside = outside_value(image),
                                               params::relative_error_bound = choices.error_bound);
}

template <class Complex>
TetMesh extract(const Complex& complex, const Vector3& spacing) {
  TetMesh mesh;
  std::unordered_map<typename Complex::Vertex_handle, std::uint32_t> number;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    Tet tet{};
    for (int i = 0; i < 4; ++i) {
      const auto vertex = cell->vertex(i);
      const auto [entry, is_new] = number.try_emplace(vertex, static_cast<std::uint32_t>(mesh.points.size()));
      if (is_new) mesh.points.push_back(from_cgal(vertex->point().point(), spacing));
      tet[i] = entry->second;
    }
    mesh.tets.push_back(tet);
  }
  return mesh;
}

template <class Tag>
BenchRun run_tagged(BenchImage& image, const BenchCriteria& bounds, const Mesh3Choices& choices) {
  using Triangulation = typename CGAL::Mesh_triangulation_3<Domain, CGAL::Default, Tag>::type;
  using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
  using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

  const CGAL::Image_3 cgal_image = to_cgal(image);
  BenchRun run;
  const Meter meter;
  const Domain domain = make_domain(image, cgal_image, choices);
  const Criteria criteria(params::facet_angle = bounds.angle_degrees, params::facet_size = bounds.size,
                          params::facet_topology = CGAL::FACET_VERTICES_ON_SURFACE,
                          params::cell_radius_edge_ratio = bounds.radius_edge, params::cell_size = bounds.cell_size);
  const auto topology = choices.manifold ? params::manifold() : params::non_manifold();
  const auto perturb = bounds.optimise ? params::perturb() : params::no_perturb();
  const auto exude = bounds.optimise ? params::exude() : params::no_exude();
  Complex complex;
  if (choices.component_seeds) {
    initialize_triangulation_from_gray_image(complex, domain, cgal_image, criteria, image.level, float());
    CGAL::refine_mesh_3(complex, domain, criteria, perturb, exude, params::no_lloyd(), params::no_odt(), topology);
  } else {
    complex = CGAL::make_mesh_3<Complex>(domain, criteria, perturb, exude, params::no_lloyd(), params::no_odt(),
                                         topology);
  }
  meter.stop(run);
  run.mesh = extract(complex, image.spacing);
  return run;
}

}  // namespace

BenchRun run_mesh3(BenchImage image, const BenchCriteria& criteria, const Mesh3Choices& choices) {
  return choices.parallel_tag ? run_tagged<CGAL::Parallel_tag>(image, criteria, choices)
                              : run_tagged<CGAL::Sequential_tag>(image, criteria, choices);
}

}  // namespace delvox::bench
