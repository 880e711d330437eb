#include "image_material_flags.h"

#include <CLI/CLI.hpp>

#include "delvox/core/errors.h"
#include "format.h"

namespace delvox::tools {

void add_image_material_options(CLI::App& app, ImageMaterialFlags& flags) {
  auto* density = app.add_option("--hu-density", flags.hu_density,
                                 "Materials from the image: density in g/cm3 = a + b * sample (after --smooth)");
  density->type_name("A,B");
  std::string laws;
  for (const DensityLaw& law : density_laws()) laws += (laws.empty() ? "" : ", ") + law.name;
  auto* modulus = app.add_option("--modulus", flags.modulus,
                                 "Young's modulus by density: " + laws + ", or E=a*rho^b in MPa and g/cm3");
  modulus->needs(density)->type_name("LAW");
  density->needs(modulus);
  app.add_option("--material-bins", flags.bins, "Most materials to make of the moduli, in equal steps")
      ->check(CLI::Range(1, 100000))
      ->needs(density)
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--peel", flags.peel, "Voxels at the surface that take their samples from further in (partial volume)")
      ->check(CLI::Range(0, 100))
      ->needs(density)
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--poisson", flags.poisson_ratio, "Poisson's ratio of these materials")
      ->check(CLI::Range(0.0, 0.499))
      ->needs(density)
      ->capture_default_str()
      ->type_name("NU");
}

std::optional<ImageMaterialOptions> parse_image_materials(const ImageMaterialFlags& flags) {
  if (flags.hu_density.empty()) return std::nullopt;
  const std::vector<std::string> numbers = split(flags.hu_density, ',');
  if (numbers.size() != 2)
    throw OptionError("--hu-density " + flags.hu_density + ": write A,B for density = A + B * sample");
  ImageMaterialOptions options;
  options.density_offset = parse_number(numbers[0], "--hu-density");
  options.density_slope = parse_number(numbers[1], "--hu-density");
  const std::optional<DensityLaw> law = find_density_law(flags.modulus);
  if (!law) {
    throw OptionError("--modulus " + flags.modulus + ": no such law; see --help for their names, or write E=a*rho^b");
  }
  options.law = *law;
  options.bins = flags.bins;
  options.poisson_ratio = flags.poisson_ratio;
  return options;
}

}  // namespace delvox::tools
