// info, check, convert, phantom and the help texts of the real program.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "delvox/volume/phantom.h"
#include "tools/run_delvox.h"

namespace delvox::test {
namespace {

using nlohmann::json;

const char* const kVerbs[] = {"info", "surface", "remesh", "tet", "check", "convert", "phantom"};

TEST(CliVerbs, HelpAndVersionExitWithZero) {
  const Outcome overview = run_delvox({"--help"});
  EXPECT_EQ(overview.code, 0);
  for (const char* verb : kVerbs) {
    EXPECT_NE(overview.out.find(verb), std::string::npos) << verb;
    const Outcome help = run_delvox({verb, "--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.out.find("Usage: delvox " + std::string(verb)), std::string::npos) << help.out;
    EXPECT_EQ(run_delvox({verb, "--version"}).out, run_delvox({"--version"}).out);
  }
}

TEST(CliVerbs, HelpShowsTheDefaults) {
  const std::string help = run_delvox({"tet", "--help"}).out;
  for (const char* word : {"=otsu", "=30", "=2", "--radius-edge", "--config", "--report"}) {
    EXPECT_NE(help.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(help.find("--border"), std::string::npos) << "an open border is for surfaces only";
}

TEST(CliVerbs, EveryKindOfPhantomIsMadeAndRead) {
  TemporaryFolder folder;
  for (const PhantomKind& kind : phantom_kinds()) {
    const std::string path = folder / (kind.name + ".nii.gz");
    const Outcome made = run_delvox({"phantom", kind.name, "--dims", "20,18,16", "-o", path, "--json"});
    ASSERT_EQ(made.code, 0) << kind.name << ": " << made.err;
    EXPECT_TRUE(json::parse(made.out).contains("truth"));
    const Outcome info = run_delvox({"info", path, "--json"});
    ASSERT_EQ(info.code, 0) << kind.name << ": " << info.err;
    EXPECT_EQ(json::parse(info.out)["volume"]["dims"], json::array({20, 18, 16}));
  }
}

TEST(CliVerbs, InfoCountsTheComponentsOfWhatItSuggests) {
  TemporaryFolder folder;
  const std::string path = folder / "torus.nii";
  ASSERT_EQ(run_delvox({"phantom", "torus", "-o", path, "--quiet"}).code, 0);
  const json info = json::parse(run_delvox({"info", path, "--json"}).out);
  ASSERT_FALSE(info["isovalues"].empty());
  EXPECT_EQ(info["isovalues"][0]["iso"], "otsu");
  EXPECT_EQ(info["volume"]["orientation"], "RAS");
  const std::string text = run_delvox({"info", path}).out;
  for (const char* word : {"voxels", "spacing", "extent", "orientation", "range", "percentiles", "otsu3:2"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word;
  }
}

TEST(CliVerbs, CheckHoldsAMeshToItsPromisesAndToBoundsOfItsOwn) {
  TemporaryFolder folder;
  const std::string volume = folder / "sphere.nii", mesh = folder / "mesh.vtu", surface = folder / "surface.stl";
  ASSERT_EQ(run_delvox({"phantom", "sphere", "-o", volume, "--quiet"}).code, 0);
  ASSERT_EQ(run_delvox({"tet", volume, "--iso", "0", "--size", "5", "-o", mesh, "--quiet"}).code, 0);
  EXPECT_EQ(run_delvox({"check", mesh, "--quiet"}).code, 0);
  EXPECT_EQ(run_delvox({"check", mesh, "--radius-edge", "0.7", "--quiet"}).code, 5);
  EXPECT_EQ(run_delvox({"check", mesh, "--volume", volume, "--same-topology", "--quiet"}).code, 0);
  EXPECT_EQ(run_delvox({"check", mesh, "--volume", volume, "--iso", "2", "--quiet"}).code, 5);
  ASSERT_EQ(run_delvox({"convert", mesh, "-o", surface, "--quiet"}).code, 0);
  EXPECT_EQ(run_delvox({"check", surface, mesh, "--quiet"}).code, 0);
  const Outcome both = run_delvox({"check", surface, mesh, "--json"});
  EXPECT_EQ(json::parse(both.out)["meshes"].size(), 2u);
}

TEST(CliVerbs, CheckFindsAHoleInAForeignMesh) {
  TemporaryFolder folder;
  write_file(folder / "open.stl",
             "solid open\n"
             "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
             "endsolid open\n");
  EXPECT_EQ(run_delvox({"check", folder / "open.stl", "--quiet"}).code, 5);
  EXPECT_EQ(run_delvox({"check", folder / "open.stl", "--border", "open", "--quiet"}).code, 0);
}

}  // namespace
}  // namespace delvox::test
