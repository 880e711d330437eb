#include "set_rules.h"

#include <gtest/gtest.h>

#include "delvox/core/errors.h"
#include "delvox/volume/phantom.h"
#include "support/test_meshes.h"
#include "tools/run_delvox.h"

namespace delvox::tools {
namespace {

using test::run_delvox;
using test::TemporaryFolder;

std::string complaint(const std::vector<std::string>& texts) {
  try {
    parse_sets(texts, nullptr);
  } catch (const OptionError& error) {
    return error.what();
  }
  return "";
}

TEST(SetRules, AreReadFromText) {
  const auto rules = parse_sets({"a=plane:1,2,3,0,0,-1", "b=plane:1,2,3,0,0,-1,0.5", "c=box:0:1,-2:3,4:5",
                                 "d=sphere:1,2,3,4", "e=normal:0,0,1,30", "f=near:1,2,3,4", "g=all"},
                                nullptr);
  ASSERT_EQ(rules.size(), 7u);
  EXPECT_EQ(std::get<PlaneRule>(rules[0].rule).normal, (Vector3{0, 0, -1}));
  EXPECT_EQ(std::get<PlaneRule>(rules[1].rule).thickness, 0.5);
  EXPECT_EQ(std::get<BoxRule>(rules[2].rule).box.min, (Point3{0, -2, 4}));
  EXPECT_EQ(std::get<SphereRule>(rules[3].rule).radius, 4);
  EXPECT_EQ(std::get<NormalRule>(rules[4].rule).degrees, 30);
  EXPECT_EQ(std::get<NearRule>(rules[5].rule).point, (Point3{1, 2, 3}));
  EXPECT_TRUE(std::holds_alternative<AllRule>(rules[6].rule));
}

TEST(SetRules, ThatMakeNoSenseAreRefusedWithTheirText) {
  for (const char* text : {"a",
                           "=all",
                           "1a=all",
                           "a b=all",
                           "a=al",
                           "a=all:",
                           "a=plane:1,2,3",
                           "a=plane:1,2,3,0,0,0",
                           "a=plane:1,2,3,0,0,1,-1",
                           "a=box:1,2,3",
                           "a=box:2:1,0:1,0:1",
                           "a=sphere:0,0,0,0",
                           "a=sphere:0,0,0,nan",
                           "a=normal:0,0,1",
                           "a=near:0,0,0,x",
                           "surface=all",
                           "REGION_2=all",
                           "a=border:up",
                           "a=border:xmin",
                           "a=border:",
                           "a23456789012345678901234567890123456789012=all"}) {
    EXPECT_NE(complaint({text}).find(text), std::string::npos) << text << ": " << complaint({text});
  }
  EXPECT_NE(complaint({"top=all", "TOP=all"}).find("twice"), std::string::npos);
}

TEST(SetRules, BordersFollowTheImageWhereverItLies) {
  PhantomOptions options = phantom_defaults("oblique-sphere");
  MeshedImage image{make_phantom("oblique-sphere", options).header(), {}};
  Vector3 sum;
  for (const char* side : {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"}) {
    const auto rules = parse_sets({std::string("a=border:") + side}, &image);
    const auto& border = std::get<BorderRule>(rules[0].rule);
    sum = sum + border.outward;
    const int axis = side[0] - 'x';
    EXPECT_GT((side[1] == 'm' && side[2] == 'a' ? 1 : -1) * border.outward[axis], 0.5) << side;
    // Every voxel centre lies before the plane, the outermost ones a quarter voxel.
    double nearest = -1e300;
    for (int corner = 0; corner < 8; ++corner) {
      Point3 index;
      for (int a = 0; a < 3; ++a) index[a] = corner >> a & 1 ? image.header.dims[static_cast<std::size_t>(a)] - 1 : 0;
      nearest = std::max(nearest, dot(image.header.index_to_world(index) - border.point, border.outward));
    }
    EXPECT_LT(nearest, 0) << side;
    EXPECT_GT(nearest, -1) << side;
  }
  EXPECT_LT(norm(sum), 1e-9) << "opposite sides look opposite ways";
}

TEST(SetRules, InAnotherFrameTheSidesChangeTheirNames) {
  const VolumeHeader header = make_phantom("sphere", phantom_defaults("sphere")).header();
  const MeshedImage as_it_is{header, FrameChange(header.frame, "ras")},
      turned{header, FrameChange(header.frame, "lps")};
  const auto plain = std::get<BorderRule>(parse_sets({"a=border:xmin"}, &as_it_is)[0].rule);
  const auto other = std::get<BorderRule>(parse_sets({"a=border:xmax"}, &turned)[0].rule);
  EXPECT_EQ(plain.point.x, -other.point.x);
  EXPECT_EQ(plain.outward.x, -other.outward.x);
}

TEST(SetRules, AnOrganCutByTheImageEdgeIsHeldThere) {
  TemporaryFolder folder;
  const std::string volume = folder / "a.nii", mesh = folder / "a.inp";
  ASSERT_EQ(run_delvox({"phantom", "sphere", "--dims", "40,40,40", "-o", volume}).code, 0);
  const auto tet = run_delvox({"tet", volume, "--size", "3", "--crop", "0:39,0:39,20:39", "--set", "cut=border:zmin",
                               "--set", "none=border:zmax", "-o", mesh, "--json"});
  EXPECT_EQ(tet.code, 5) << "an empty set breaks a promise";
  EXPECT_NE(tet.err.find("none"), std::string::npos) << tet.err;
  const auto converted =
      run_delvox({"convert", mesh, "--set", "x=all", "--order", "2", "--unit", "m", "-o", folder / "b.inp"});
  EXPECT_EQ(converted.code, 0) << converted.err;
  const std::string text = test::read_file(folder / "b.inp");
  for (const char* word : {"in m ", "C3D10", "NSET=cut", "NAME=cut", "ELSET=x"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(run_delvox({"check", folder / "b.inp", "--quiet"}).code, 0);
}

}  // namespace
}  // namespace delvox::tools
