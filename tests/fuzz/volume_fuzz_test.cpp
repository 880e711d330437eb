// Mutated volume files, a fixed seed: each must be read or refused by InputError, and no allocation may be out of
// proportion to the file. Run under the asan preset this is where memory errors show.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <random>

#include "delvox/volume/write_volume.h"
#include "volume/tiff_files.h"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
using LeakExemption = __lsan::ScopedDisabler;
#else
struct LeakExemption {
  ~LeakExemption() {}
};
#endif

namespace {

// The seeds are below 64 kB; deflate expands 1032 times at most and a byte becomes a float.
constexpr std::size_t kLargestAllocation = std::size_t{256} << 20;
std::size_t g_largest_allocation = 0;

}  // namespace

// Out of line, or GCC pairs the inlined malloc with delete and warns.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (size > g_largest_allocation) g_largest_allocation = size;
  void* memory = size > kLargestAllocation ? nullptr : std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace delvox {
namespace {

using namespace delvox::testing;

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  /// One to four changes, most of them within the first `header` bytes.
  std::string mutate(std::string bytes, std::size_t header) {
    for (std::size_t changes = 1 + below(4); changes > 0 && !bytes.empty(); --changes) {
      const std::size_t range = below(8) == 0 ? bytes.size() : std::min(header, bytes.size());
      change(bytes, below(range));
    }
    return bytes;
  }
  std::size_t below(std::size_t limit) { return static_cast<std::size_t>(random_() % limit); }

 private:
  void change(std::string& bytes, std::size_t at) {
    static constexpr std::uint64_t kExtremes[] = {0, 1, 2, 3, 127, 128, 255, 256, 32767, 32768, 65535, 65536,
                                                  2147483647,
                                                  2147483648u, 4294967295u, 1000000000u, 1099511627776u,
                                                  9223372036854775807u, 9223372036854775808u, 18446744073709551615u,
                                                  0x7f800000u, 0x7fc00000u, 0xff800000u};
    switch (below(7)) {
      case 0: bytes[at] = static_cast<char>(random_()); break;
      case 1: bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8))); break;
      case 2: bytes.resize(at); break;
      case 3: bytes.erase(at, 1 + below(8)); break;
      case 4: bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(16))); break;
      default: {
        const std::string value = bytes_of(kExtremes[below(std::size(kExtremes))], below(4) == 0);
        const std::size_t width = std::min<std::size_t>(std::size_t{1} << below(4), bytes.size() - at);
        bytes.replace(at, width, value.substr(0, width));
      }
    }
  }

  std::mt19937_64 random_;
};

class VolumeFuzz : public ::testing::Test {
 protected:
  /// Reads `rounds` mutants of each seed under this name.
  void fuzz(const std::vector<std::string>& seeds, const std::string& name, std::size_t header, int rounds,
            bool zip = false) {
    g_largest_allocation = 0;
    Mutator mutator(20240607);
    int accepted = 0;
    for (const std::string& seed : seeds) {
      for (int round = 0; round < rounds; ++round) {
        std::string mutant = mutator.mutate(seed, header);
        if (zip) mutant = gzipped(mutant);
        accepted += try_read(write_file(folder_ / name, mutant)) ? 1 : 0;
        ASSERT_FALSE(HasFailure()) << "round " << round;
      }
    }
    if (check_allocations_) {
      EXPECT_LE(g_largest_allocation, kLargestAllocation);
    }
    std::cout << accepted << " of " << rounds * static_cast<int>(seeds.size())
              << " mutants were accepted; largest allocation " << g_largest_allocation << " bytes\n";
  }
  bool try_read(const fs::path& path) {
    ReadVolumeOptions options;
    try {
      read_volume(path, options);
      return true;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.find('\n'), std::string::npos);
      EXPECT_NE(text.find("; "), std::string::npos) << text;
      return false;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "not an InputError: " << error.what();
      return false;
    }
  }

  TempFolder folder_;
  bool check_allocations_ = true;
};

std::vector<std::string> nifti_seeds() {
  std::vector<std::string> seeds;
  for (int version : {1, 2}) {
    for (bool big_endian : {false, true}) {
      NiftiFile file;
      file.version = version;
      file.big_endian = big_endian;
      file.dim = {4, 5, 4, 3, 2, 1, 1, 1};
      file.datatype = 4;
      file.bitpix = 16;
      file.qform_code = 1;
      file.payload = counting_payload<std::int16_t>(120, big_endian);
      seeds.push_back(file.bytes());
    }
  }
  return seeds;
}

TEST_F(VolumeFuzz, Nifti) { fuzz(nifti_seeds(), "scan.nii", 560, 1000); }

TEST_F(VolumeFuzz, NiftiMutatedInsideGzip) { fuzz(nifti_seeds(), "scan.nii.gz", 560, 500, true); }

TEST_F(VolumeFuzz, MutatedGzip) {
  std::vector<std::string> seeds;
  for (const std::string& seed : nifti_seeds()) seeds.push_back(gzipped(seed));
  fuzz(seeds, "scan.nii.gz", 200, 500);
}

TEST_F(VolumeFuzz, NiftiPair) {
  NiftiFile file;
  file.pair = true;
  write_file(folder_ / "scan.img", counting_payload<std::uint8_t>(24));
  fuzz({file.header()}, "scan.hdr", 348, 1000);
}

TEST_F(VolumeFuzz, Inrimage) {
  std::string header = "#INRIMAGE-4#{\nXDIM=5\nYDIM=4\nZDIM=3\nVDIM=1\nTYPE=signed fixed\nPIXSIZE=16 bits\nSCALE=2**0\n"
                       "CPU=decm\nVX=0.5\nVY=1\nVZ=2\nTX=1\n";
  header += std::string(252 - header.size(), '\n') + "##}\n";
  fuzz({header + counting_payload<std::int16_t>(60)}, "scan.inr", 150, 3000);
}

TEST_F(VolumeFuzz, RawJson) {
  write_file(folder_ / "scan.raw", counting_payload<std::uint16_t>(60));
  fuzz({R"({"file": "scan.raw", "dims": [5, 4, 3], "type": "uint16", "endian": "little", "offset": 0, "slope": 1,
            "spacing": [0.5, 0.5, 1.0], "origin": [1, 2, 3], "direction": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
            "unit": "mm", "frame": "RAS"})",
        R"({"file": "scan.raw", "dims": [5, 4, 3], "type": "uint16", "affine": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]})"},
       "scan.json", 400, 1500);
}

TEST_F(VolumeFuzz, Tiff) {
  TIFFSetWarningHandler(nullptr);
  std::vector<std::string> seeds;
  for (const std::string mode : {"wl", "wb", "w8"}) {
    for (int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_PACKBITS, COMPRESSION_ADOBE_DEFLATE,
                            COMPRESSION_LZMA, COMPRESSION_ZSTD, COMPRESSION_JPEG}) {
      if (!TIFFIsCODECConfigured(static_cast<std::uint16_t>(compression))) continue;
      TiffSpec spec;
      spec.mode = mode;
      spec.pages = 2;
      spec.compression = compression;
      spec.tile = compression == COMPRESSION_LZW || compression == COMPRESSION_NONE ? 16 : 0;
      if (compression == COMPRESSION_JPEG) spec.width = spec.height = spec.rows_per_strip = 16;
      spec.description = "ImageJ=1.53\nimages=2\nslices=2\nunit=mm\nspacing=2\n";
      seeds.push_back(read_file(write_tiff_file(folder_ / "seed.tif", spec)));
    }
  }
  TiffSpec one;
  one.pages = 1;
  one.description = "ImageJ=1.53\nimages=2\nslices=2\n";
  seeds.push_back(read_file(write_tiff_file(folder_ / "seed.tif", one)) + std::string(20, '\1'));
  TiffSpec fax;
  fax.bits = 1;
  fax.compression = COMPRESSION_CCITTFAX4;
  seeds.push_back(read_file(write_tiff_file(folder_ / "seed.tif", fax)));
  fuzz(seeds, "stack.tif", 1 << 16, 200);
}

TEST_F(VolumeFuzz, Vdb) {
  // OpenVDB forgets half-built nodes when its stream throws: bytes lost for good at each refused file, no more.
  const LeakExemption exemption;
  VolumeHeader header;
  header.dims = {9, 7, 10};
  write_volume(Volume(header, counting_samples(630)), folder_ / "seed.vdb");
  const std::string seed = read_file(folder_ / "seed.vdb");
  // A tile of 13 bytes may stand for 4096^3 voxels: only the machine's memory, which is asked first, limits VDB.
  check_allocations_ = false;
  fuzz({seed}, "scan.vdb", 600, 1500);
  fuzz({seed}, "scan.vdb", seed.size(), 1500);
}

}  // namespace
}  // namespace delvox
