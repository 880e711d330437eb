#pragma once

// What is promised of every mesh, held on real volumes with the real program.

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <ostream>

#include "delvox/mesh_io/read_mesh.h"
#include "run_delvox.h"

namespace delvox::test {
namespace fs = std::filesystem;

inline constexpr const char* kSamples = "/usr/share/doc/libcgal-dev/data.tar.gz";

/// A size and what it gives.
struct Aim {
  double size;       ///< mm
  std::size_t tets;  ///< about so many
  double grade = 0;
};

struct Scan {
  std::string name, file;
  std::vector<std::string> options;
  std::vector<Aim> aims;
  std::vector<std::string> crops = {};
  double half_voxel = 0;      ///< mm
};

inline std::ostream& operator<<(std::ostream& out, const Scan& scan) { return out << scan.name; }

/// Unpacks one of Debian's sample volumes; empty if they are not installed.
inline std::string unpack_sample(const std::string& file, const TemporaryFolder& folder) {
  if (!fs::exists(kSamples)) return {};
  const std::string command = "tar -xzf " + std::string(kSamples) + " -C '" + folder.path().string() + "' data/images/" + file;
  return std::system(command.c_str()) == 0 ? folder / ("data/images/" + file) : "";
}

inline std::string find_scan(const std::string& file) {
  const char* folder = std::getenv("DELVOX_SCANS");
  const fs::path path = fs::path(folder != nullptr ? folder : DELVOX_DEFAULT_SCANS) / file;
  return fs::exists(path) ? path.string() : "";
}

inline std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Every promise verified at the end of the run, about as many tets as meant, the same bytes on a second run, and the
/// full check against the voxels: surface nodes within 1e-4 voxel, each surface ball within its bound. Hardly a tet has
/// a dihedral angle below 15 degrees, and each that has is listed.
inline void expect_promises_held(const std::string& volume, const std::vector<std::string>& options, const Aim& aim,
                                 const TemporaryFolder& folder) {
  SCOPED_TRACE(volume + " at size " + std::to_string(aim.size) + ", grade " + std::to_string(aim.grade));
  const std::string first = folder / "first.vtu", second = folder / "second.vtu";
  const std::string report_path = folder / "report.json";
  const auto mesh = [&](const std::string& out) {
    return run_delvox(joined({"tet", volume, "--size", std::to_string(aim.size), "--grade", std::to_string(aim.grade),
                              "-o", out, "--quiet", "--report", report_path},
                             options));
  };
  const Outcome run = mesh(first);
  ASSERT_EQ(run.code, 0) << run.err;
  const double tets = static_cast<double>(std::get<TetMesh>(read_mesh(first).mesh).tets.size());
  EXPECT_NEAR(tets / static_cast<double>(aim.tets), 1, 0.2) << tets << " tets";
  const auto report = nlohmann::json::parse(read_file(report_path));
  const auto& unmet = report["slivers"]["unmet"];
  EXPECT_LE(static_cast<double>(unmet.size()), 1 + tets / 1e5) << unmet.dump(1);
  EXPECT_EQ(report["check"]["statistics"]["dihedral_degrees"]["min"] >= 15, unmet.empty());
  ASSERT_EQ(mesh(second).code, 0);
  EXPECT_TRUE(read_file(first) == read_file(second)) << "a second run gave other bytes";
  const double ball = 4.0 / 3 * 3.14159265358979 * aim.size * aim.size * aim.size;
  const Outcome check =
      run_delvox(joined({"check", first, "--volume", volume, "--min-component", std::to_string(ball)}, options));
  EXPECT_EQ(check.code, 0) << check.out << check.err;
}

/// At half a voxel the mesh has the components and the Euler number of the trilinear isosurface.
inline void expect_topology_of_the_voxels(const Scan& scan, const std::string& volume, const TemporaryFolder& folder) {
  const std::string out = folder / "crop.vtu", size = std::to_string(scan.half_voxel);
  for (const std::string& crop : scan.crops) {
    const std::vector<std::string> options = joined(scan.options, {"--crop", crop, "--min-component", "0"});
    for (const char* verb : {"surface", "tet"}) {
      SCOPED_TRACE(verb + (" " + crop));
      const Outcome run = run_delvox(joined({verb, volume, "--size", size, "-o", out, "--quiet"}, options));
      ASSERT_EQ(run.code, 0) << run.err;
      const Outcome check = run_delvox(joined({"check", out, "--volume", volume, "--same-topology"}, options));
      EXPECT_EQ(check.code, 0) << check.out << check.err;
    }
  }
}

}  // namespace delvox::test
