#include "deck_json.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "delvox/core/errors.h"
#include "tools/run_delvox.h"

namespace delvox::tools {
namespace {

using test::read_file;
using test::run_delvox;
using test::TemporaryFolder;
using test::write_file;

constexpr const char* kDeck = R"({
  "material": {"name": "bone", "youngs_modulus_mpa": 17000, "poisson_ratio": 0.3, "density_kg_m3": 1900},
  "supports": [{"set": "base"}, {"set": "side", "axes": "x"}],
  "displacements": [{"set": "top", "z_mm": -0.1}],
  "pressures": [{"set": "side", "mpa": 2}],
  "gravity_m_s2": [0, 0, -9.81]})";

std::string complaint(const std::string& text) {
  const TemporaryFolder folder;
  write_file(folder / "deck.json", text);
  try {
    read_deck(folder / "deck.json", {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(DeckJson, IsReadWhole) {
  const TemporaryFolder folder;
  write_file(folder / "deck.json", kDeck);
  const DeckFile file = read_deck(folder / "deck.json", {});
  ASSERT_EQ(file.material.size(), 1u);
  EXPECT_EQ(file.material[0].density_kg_m3, 1900);
  ASSERT_EQ(file.deck.displacements.size(), 3u);
  EXPECT_EQ(file.deck.displacements[0].mm, (std::array<std::optional<double>, 3>{0.0, 0.0, 0.0}));
  EXPECT_EQ(file.deck.displacements[1].mm, (std::array<std::optional<double>, 3>{0.0, std::nullopt, std::nullopt}));
  EXPECT_EQ(file.deck.displacements[2].mm, (std::array<std::optional<double>, 3>{std::nullopt, std::nullopt, -0.1}));
  EXPECT_EQ(file.deck.gravity_m_s2.z, -9.81);
  EXPECT_EQ(sets_of(file.deck), (std::vector<std::string>{"base", "side", "top"}));
}

TEST(DeckJson, ThatMakesNoSenseIsRefusedWithThePlace) {
  EXPECT_NE(complaint("{").find("not JSON"), std::string::npos);
  EXPECT_NE(complaint("[]").find("object"), std::string::npos);
  EXPECT_NE(complaint("{}").find("nothing holds"), std::string::npos);
  EXPECT_NE(complaint(R"({"suports": []})").find("suports"), std::string::npos);
  EXPECT_NE(complaint(R"({"supports": [{"set": "a", "axes": "w"}]})").find("\"supports\"[0]"), std::string::npos);
  EXPECT_NE(complaint(R"({"supports": [{"axes": "x"}]})").find("\"set\""), std::string::npos);
  EXPECT_NE(complaint(R"({"displacements": [{"set": "a"}]})").find("x_mm"), std::string::npos);
  EXPECT_NE(complaint(R"({"pressures": [{"set": "a", "mpa": "2"}]})").find("number"), std::string::npos);
  EXPECT_NE(complaint(R"({"material": "bone", "supports": [{"set": "a"}]})").find("--materials"), std::string::npos);
  EXPECT_NE(complaint(R"({"material": {"name": "m", "youngs_modulus_mpa": 1, "poisson_ratio": 0.5}})").find("poisson"),
            std::string::npos);
}

TEST(DeckJson, ADeckOfAScanRunsInCalculixAsItIs) {
  const TemporaryFolder folder;
  const std::string volume = folder / "a.nii", deck = folder / "deck.json", out = folder / "a.inp";
  write_file(deck, kDeck);
  ASSERT_EQ(run_delvox({"phantom", "sphere", "--dims", "40,40,40", "-o", volume}).code, 0);
  const std::vector<std::string> arguments{"tet",    volume,
                                           "--size", "4",
                                           "--set",  "base=plane:0,0,-10,0,0,-1",
                                           "--set",  "top=near:0,0,99,5",
                                           "--set",  "side=normal:1,0,0,30",
                                           "--deck", deck,
                                           "-o",     out,
                                           "--quiet"};
  const auto run = run_delvox(arguments);
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string text = read_file(out);
  for (const char* word : {"*MATERIAL, NAME=bone", "*SOLID SECTION, ELSET=REGION_1", "base, 3, 3, 0\n",
                           "top, 3, 3, -0.1\n", "EALL, GRAV, 9810, 0, 0, -1\n", "*DENSITY\n1.9e-09\n", "*END STEP\n"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(run_delvox({"check", out, "--quiet"}).code, 0);
  if (std::system("which ccx >/dev/null 2>&1") != 0) GTEST_SKIP() << "no ccx to run it";
  EXPECT_EQ(std::system(("cd '" + folder.path().string() + "' && ccx -i a > log 2>&1").c_str()), 0);
  EXPECT_EQ(read_file(folder / "log").find("ERROR"), std::string::npos) << read_file(folder / "log");
  EXPECT_FALSE(read_file(folder / "a.frd").empty());
}

TEST(DeckJson, WhatADeckNeedsIsAskedForBeforeMeshing) {
  const TemporaryFolder folder;
  const std::string volume = folder / "a.nii", deck = folder / "deck.json";
  write_file(deck, R"({"supports": [{"set": "base"}], "material": "bone"})");
  write_file(folder / "organs.json", R"({"bone": {"youngs_modulus_mpa": 1, "poisson_ratio": 0.3}})");
  ASSERT_EQ(run_delvox({"phantom", "sphere", "--dims", "20,20,20", "-o", volume}).code, 0);
  const auto fails = [&](const std::vector<std::string>& more, const char* word) {
    std::vector<std::string> arguments{"tet", volume, "--deck", deck};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = run_delvox(arguments);
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "a.inp"));
  };
  const std::string organs = folder / "organs.json";
  fails({"-o", folder / "a.inp", "--set", "base=all"}, "--materials");
  fails({"-o", folder / "a.inp", "--materials", organs}, "base");
  fails({"-o", folder / "a.vtu", "--materials", organs, "--set", "base=all"}, ".inp");
  fails({"-o", folder / "a.inp", "--materials", organs, "--material", "fat", "--set", "base=all"}, "fat");
  write_file(deck, R"({"supports": [{"set": "base"}]})");
  fails({"-o", folder / "a.inp", "--set", "base=all"}, "states no material");
}

}  // namespace
}  // namespace delvox::tools
