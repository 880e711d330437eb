#pragma once

// CGAL's sample surfaces (Debian's libcgal-demo) through the real program: clean closed ones are meshed, all others
// refused with their reason.

#include <gtest/gtest.h>

#include <chrono>

#include "tools/volume_bars.h"

namespace delvox::test {

/// All of them, unpacked; empty if they are not installed.
inline std::vector<fs::path> unpack_sample_surfaces(const TemporaryFolder& folder) {
  std::vector<fs::path> paths;
  if (!fs::exists(kSamples)) return paths;
  const std::string command = "tar -xzf " + std::string(kSamples) + " -C '" + folder.path().string() + "' data/meshes";
  if (std::system(command.c_str()) != 0) return paths;
  for (const auto& entry : fs::directory_iterator(folder.path() / "data/meshes")) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// Meshes one with both verbs within so many seconds, each mesh held to everything that `check` can tell, and the
/// distance from the mesh to its surface.
inline void expect_meshed(const fs::path& surface, const TemporaryFolder& folder, const std::vector<std::string>& options,
                          double seconds = 60) {
  for (const char* verb : {"remesh", "tet"}) {
    SCOPED_TRACE(verb + (" " + surface.filename().string()));
    const auto begin = std::chrono::steady_clock::now();
    const std::string out = folder / "out.vtu";
    const Outcome run = run_delvox(joined({verb, surface.string(), "-o", out, "--quiet"}, options));
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), seconds);
    const Outcome check = run_delvox({"check", out, "--surface", surface.string()});
    EXPECT_EQ(check.code, 0) << check.out << check.err;
  }
}

/// Refused by both verbs: one line with one of the reasons and a place.
inline void expect_refused(const fs::path& surface, const TemporaryFolder& folder) {
  for (const char* verb : {"remesh", "tet"}) {
    SCOPED_TRACE(verb + (" " + surface.filename().string()));
    const Outcome run = run_delvox({verb, surface.string(), "-o", folder / "refused.vtu", "--quiet"});
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_EQ(line_count(run.err), 1u) << run.err;
    const bool reason = run.err.find("the surface is open: ") != std::string::npos ||
                        run.err.find("the surface is not manifold: ") != std::string::npos ||
                        run.err.find("the surface crosses itself: ") != std::string::npos;
    EXPECT_TRUE(reason && run.err.find("triangle") != std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder / "refused.vtu"));
  }
}

}  // namespace delvox::test
