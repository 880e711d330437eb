#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <sys/resource.h>
#include <unistd.h>

#include "delvox/volume/write_volume.h"
#include "volume/volume_files.h"

namespace delvox {
namespace {

using namespace delvox::testing;

/// From OpenVDB's registry: Grid::create() would compile the whole of each grid type here, for minutes.
template <class Grid>
openvdb::GridBase::Ptr empty_grid() {
  openvdb::initialize();
  return openvdb::GridBase::createGrid(Grid::gridType());
}

template <class Grid>
typename Grid::Ptr make_grid(const openvdb::Coord& low, const openvdb::Coord& high) {
  typename Grid::Ptr grid = openvdb::gridPtrCast<Grid>(empty_grid<Grid>());
  int n = 1;
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i, ++n) {
        grid->tree().setValue({i, j, k}, static_cast<typename Grid::ValueType>(n));
      }
    }
  }
  return grid;
}

fs::path save(const fs::path& path, const openvdb::GridPtrVec& grids, bool stream = false) {
  openvdb::initialize();
  if (stream) {
    std::ofstream out(path, std::ios::binary);
    openvdb::io::Stream(out).write(grids);
  } else {
    openvdb::io::File(path.string()).write(grids);
  }
  return path;
}

TEST(VdbReader, ReadsGridsOfOthersWithTheirTransform) {
  const TempFolder folder;
  for (const bool stream : {false, true}) {
    const auto grid = make_grid<openvdb::FloatGrid>({-2, 3, 5}, {0, 4, 6});
    openvdb::math::Mat4d matrix(0.5, 0.1, 0., 0., 0., 2., 0.2, 0., 0.3, 0., 3., 0., 10., 20., 30., 1.);  // row vectors
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    const Volume volume = read_volume(save(folder / "a.vdb", {grid}, stream));
    EXPECT_EQ(volume.dims(), (std::array<int, 3>{3, 2, 2}));
    EXPECT_EQ(volume.value(0, 0, 0), 1);
    EXPECT_EQ(volume.value(2, 1, 1), 12);
    const openvdb::Vec3d expected = grid->indexToWorld(openvdb::Vec3d(-1, 4, 6));
    const Point3 actual = volume.header().index_to_world({1, 1, 1});
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(actual[axis], expected[axis], 1e-12);
    EXPECT_TRUE(warns(volume, "millimetres assumed"));
  }
}

TEST(VdbReader, ConvertsOtherScalarsAndTakesTheFirstScalarGrid) {
  const TempFolder folder;
  const openvdb::Coord low(0, 0, 0), high(1, 2, 3);
  const auto check = [&](const openvdb::GridPtrVec& grids, const std::string& type) {
    const Volume volume = read_volume(save(folder / "a.vdb", grids));
    EXPECT_EQ(volume.value(1, 2, 3), 24);
    EXPECT_EQ(volume.header().sample_type, type);
  };
  check({make_grid<openvdb::DoubleGrid>(low, high)}, "float64");
  check({make_grid<openvdb::Int32Grid>(low, high)}, "int32");
  check({make_grid<openvdb::Int64Grid>(low, high)}, "int64");
  check({empty_grid<openvdb::Vec3SGrid>(), make_grid<openvdb::FloatGrid>(low, high)}, "float32");
  const auto half = make_grid<openvdb::FloatGrid>(low, high);
  half->setSaveFloatAsHalf(true);
  check({half}, "float16");
}

TEST(VdbReader, KeepsTheBackgroundWithinTheBox) {
  const TempFolder folder;
  const auto grid = make_grid<openvdb::FloatGrid>({0, 0, 0}, {0, 0, 0});
  grid->tree().root().setBackground(3, /*updateChildNodes=*/true);
  grid->tree().setValue({20, 0, 0}, 2);
  const Volume volume = read_volume(save(folder / "a.vdb", {grid}));
  EXPECT_EQ(volume.dims()[0], 21);
  EXPECT_EQ(volume.value(10, 0, 0), 3);
}

TEST(VdbReader, RefusesWhatHoldsNoVolume) {
  const TempFolder folder;
  openvdb::initialize();
  EXPECT_NE(read_error(save(folder / "a.vdb", {empty_grid<openvdb::Vec3SGrid>()})).find("no grid of scalars"),
            std::string::npos);
  EXPECT_NE(read_error(save(folder / "b.vdb", {empty_grid<openvdb::FloatGrid>()})).find("no active voxel"),
            std::string::npos);
  const auto frustum = make_grid<openvdb::FloatGrid>({0, 0, 0}, {2, 2, 2});
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 10, 1));
  EXPECT_NE(read_error(save(folder / "c.vdb", {frustum})).find("frustum"), std::string::npos);
  const auto wide = make_grid<openvdb::FloatGrid>({0, 0, 0}, {0, 0, 0});
  wide->tree().setValue({1 << 20, 1 << 20, 1 << 20}, 1);
  EXPECT_NE(read_error(save(folder / "d.vdb", {wide})).find("memory"), std::string::npos);
}

/// Limits the address space of this process to so much more than it has, for as long as it lives.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::uint64_t more) {
    ::getrlimit(RLIMIT_AS, &before_);
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit = before_;
    limit.rlim_cur = std::min<rlim_t>(before_.rlim_cur, pages * static_cast<std::uint64_t>(::getpagesize()) + more);
    ::setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { ::setrlimit(RLIMIT_AS, &before_); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
};

TEST(VdbReader, RefusesTilesThatExpandBeyondTheMemoryThatIsAvailable) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer's own addresses are beyond any limit";
#endif
  const TempFolder folder;
  const auto grid = make_grid<openvdb::FloatGrid>({0, 0, 0}, {0, 0, 0});
  constexpr int kTile = 128;  // of the lower internal nodes
  for (int i = 0; i < 5; ++i) grid->tree().addTile(2, {i * kTile, i * kTile, i * kTile}, 1, /*state=*/true);
  const fs::path path = save(folder / "a.vdb", {grid});
  EXPECT_LT(fs::file_size(path), 1u << 20);
  const MemoryLimit limit(std::uint64_t{1} << 30);  // 640^3 voxels take twice that
  const std::string error = read_error(path);
  EXPECT_NE(error.find("640 x 640 x 640"), std::string::npos) << error;
  EXPECT_NE(error.find("available"), std::string::npos) << error;
  EXPECT_NE(error.find("a.vdb"), std::string::npos) << error;
}

TEST(VdbReader, RefusesTruncation) {
  const TempFolder folder;
  const std::string bytes = read_file(save(folder / "a.vdb", {make_grid<openvdb::FloatGrid>({0, 0, 0}, {9, 9, 9})}));
  for (std::size_t size : {std::size_t{8}, std::size_t{30}, std::size_t{100}, bytes.size() / 2, bytes.size() - 5}) {
    EXPECT_NE(read_error(write_file(folder / "cut.vdb", bytes.substr(0, size))), "") << size;
  }
}

}  // namespace
}  // namespace delvox
