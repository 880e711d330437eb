#include <gtest/gtest.h>

#include "volume/volume_files.h"

namespace delvox {
namespace {

using namespace delvox::testing;

std::string inr_header(const std::string& fields, std::size_t multiple = 256) {
  std::string header = "#INRIMAGE-4#{\n" + fields;
  while ((header.size() + 4) % multiple != 0) header += '\n';
  return header + "##}\n";
}

std::string fields(const std::string& type, int bits, const std::string& cpu, const std::string& more = "") {
  return "XDIM=2\nYDIM=03\nZDIM=4\nVDIM=1\nTYPE=" + type + "\nPIXSIZE=" + std::to_string(bits) +
         " bits\nSCALE=2**0\nCPU=" + cpu + "\nVX=0.5\nVY=1.5\nVZ=2.25\n#GEOMETRY=CARTESIAN\n" + more;
}

Volume read_bytes(const std::string& bytes, const std::string& name = "scan.inr") {
  const TempFolder folder;
  return read_volume(write_file(folder / name, bytes));
}

TEST(InrimageReader, ReadsEveryTypeInBothByteOrders) {
  for (const std::string cpu : {"decm", "alpha", "pc", "sun", "sgi"}) {
    const bool big = cpu[0] == 's';
    const std::vector<std::pair<std::string, std::string>> cases = {
        {fields("unsigned fixed", 8, cpu), counting_payload<std::uint8_t>(24, big)},
        {fields("signed fixed", 8, cpu), counting_payload<std::int8_t>(24, big)},
        {fields("unsigned fixed", 16, cpu), counting_payload<std::uint16_t>(24, big)},
        {fields("signed fixed", 16, cpu), counting_payload<std::int16_t>(24, big)},
        {fields("unsigned fixed", 32, cpu), counting_payload<std::uint32_t>(24, big)},
        {fields("signed fixed", 64, cpu), counting_payload<std::int64_t>(24, big)},
        {fields("float", 32, cpu), counting_payload<float>(24, big)},
        {fields("float", 64, cpu), counting_payload<double>(24, big)}};
    for (const auto& [header, payload] : cases) {
      const Volume volume = read_bytes(inr_header(header) + payload);
      EXPECT_EQ(volume.samples(), counting_samples(24)) << header;
      EXPECT_EQ(volume.header().frame, Frame::kUnknown);
      EXPECT_TRUE(volume.header().warnings.empty());
    }
  }
}

TEST(InrimageReader, PutsTheFirstVoxelAtZeroOrAtTheTranslation) {
  const std::string payload = counting_payload<std::uint8_t>(24);
  const Volume plain = read_bytes(inr_header(fields("unsigned fixed", 8, "decm")) + payload);
  EXPECT_EQ(plain.header().index_to_world({1, 1, 1}), (Point3{0.5, 1.5, 2.25}));
  const Volume moved = read_bytes(inr_header(fields("unsigned fixed", 8, "decm", "TX=10\nTY=-1\nTZ=3\n")) + payload);
  EXPECT_EQ(moved.header().index_to_world({0, 0, 0}), (Point3{10, -1, 3}));
}

TEST(InrimageReader, ReadsGzipLongHeadersAndHeadersOfOddLength) {
  const std::string payload = counting_payload<std::uint8_t>(24);
  const std::string header = inr_header(fields("unsigned fixed", 8, "decm"));
  EXPECT_EQ(read_bytes(gzipped(header + payload), "scan.inr.gz").samples(), counting_samples(24));
  const std::string comment = "#" + std::string(400, 'c') + "\n";
  const std::string longer = inr_header(fields("unsigned fixed", 8, "decm", comment));
  EXPECT_EQ(longer.size() % 256, 0u);
  EXPECT_EQ(read_bytes(longer + payload).samples(), counting_samples(24));
  EXPECT_EQ(read_bytes(inr_header(fields("unsigned fixed", 8, "decm"), 1) + payload).samples(), counting_samples(24));
}

TEST(InrimageReader, WarnsOfWhatItAssumesAndIgnores) {
  const std::string bare = "XDIM=1\nYDIM=1\nZDIM=1\nTYPE=signed fixed\nPIXSIZE=16 bits\nRX=0.1\nSCALE=2**-3\n";
  const Volume volume = read_bytes(inr_header(bare) + std::string(2, '\1'));
  EXPECT_TRUE(warns(volume, "CPU"));
  EXPECT_TRUE(warns(volume, "1 mm"));
  EXPECT_TRUE(warns(volume, "RX"));
  EXPECT_TRUE(warns(volume, "SCALE"));
}

TEST(InrimageReader, RefusesWhatItCannotRead) {
  const TempFolder folder;
  const auto error = [&](const std::string& bytes) { return read_error(write_file(folder / "scan.inr", bytes)); };
  const std::string payload(1000, '\1');
  EXPECT_NE(error(inr_header("XDIM=2\nYDIM=2\nZDIM=2\nVDIM=3\nTYPE=float\nPIXSIZE=32 bits\nCPU=pc\n") + payload)
                .find("VDIM=3"), std::string::npos);
  EXPECT_NE(error(inr_header("XDIM=2\nYDIM=2\nZDIM=2\nTYPE=packed\nPIXSIZE=32 bits\nCPU=pc\n") + payload).find("TYPE"),
            std::string::npos);
  EXPECT_NE(error(inr_header(fields("float", 32, "vax")) + payload).find("CPU=vax"), std::string::npos);
  EXPECT_NE(error("#INRIMAGE-4#{\nXDIM=2\n").find("truncated"), std::string::npos);
  EXPECT_NE(error(inr_header("XDIM=2\nYDIM=2\n") + payload).find("lacks ZDIM"), std::string::npos);
  EXPECT_NE(error(inr_header("XDIM=two\nYDIM=2\nZDIM=2\n") + payload).find("XDIM=two"), std::string::npos);
}

}  // namespace
}  // namespace delvox
