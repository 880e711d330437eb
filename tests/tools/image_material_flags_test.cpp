#include "image_material_flags.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "delvox/core/errors.h"
#include "tools/run_delvox.h"

namespace delvox::tools {
namespace {

TEST(ImageMaterialFlags, ThatMakeNoSenseAreRefused) {
  EXPECT_FALSE(parse_image_materials({}));
  EXPECT_THROW(parse_image_materials({"1", "keller"}), OptionError);
  EXPECT_THROW(parse_image_materials({"1,x", "keller"}), OptionError);
  EXPECT_THROW(parse_image_materials({"0,0.001", "kellar"}), OptionError);
  const auto options = parse_image_materials({"0.1,0.001", "E=2*rho^3", 7, 0, 0.4});
  ASSERT_TRUE(options);
  EXPECT_EQ(options->density_offset, 0.1);
  EXPECT_EQ(options->bins, 7u);
  EXPECT_EQ(options->poisson_ratio, 0.4);
}

TEST(ImageMaterialFlags, GiveEachBinItsRegionAndMaterial) {
  const test::TemporaryFolder folder;
  const std::string volume = folder / "a.nii", report = folder / "a.json";
  ASSERT_EQ(test::run_delvox({"phantom", "sphere", "--dims", "30,30,30", "-o", volume}).code, 0);
  // Samples of the phantom rise towards the middle from about -9 at its surface.
  const auto run = test::run_delvox({"tet",
                                     volume,
                                     "--size",
                                     "3",
                                     "--hu-density",
                                     "0.5,0.02",
                                     "--modulus",
                                     "keller",
                                     "--material-bins",
                                     "6",
                                     "--peel",
                                     "1",
                                     "--frame",
                                     "lps",
                                     "-o",
                                     folder / "a.inp",
                                     "-o",
                                     folder / "a.feb",
                                     "-o",
                                     folder / "a.bdf",
                                     "--report",
                                     report,
                                     "--quiet"});
  ASSERT_EQ(run.code, 0) << run.err;
  const auto json = nlohmann::json::parse(test::read_file(report));
  ASSERT_GT(json["materials"].size(), 1u);
  EXPECT_LE(json["materials"].size(), 6u);
  const std::string inp = test::read_file(folder / "a.inp");
  EXPECT_NE(inp.find("*SOLID SECTION, ELSET=REGION_2, MATERIAL=bin_02"), std::string::npos);
  EXPECT_NE(test::read_file(folder / "a.feb").find("mat=\"bin_02\""), std::string::npos);
  EXPECT_NE(test::read_file(folder / "a.bdf").find("MAT1*   2 "), std::string::npos);
  EXPECT_EQ(test::run_delvox({"tet", volume, "--modulus", "keller", "-o", folder / "b.inp"}).code, 2);
  EXPECT_EQ(test::run_delvox({"tet", volume, "--hu-density", "0,1", "-o", folder / "b.inp"}).code, 2);
}

}  // namespace
}  // namespace delvox::tools
