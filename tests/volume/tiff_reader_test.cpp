#include <gtest/gtest.h>

#include "volume/natural_order.h"
#include "volume/tiff_files.h"

namespace delvox {
namespace {

using namespace delvox::testing;

Volume read_spec(const TiffSpec& spec, const ReadVolumeOptions& options = {}) {
  const TempFolder folder;
  return read_volume(write_tiff_file(folder / "stack.tif", spec), options);
}

TEST(NaturalOrder, CountsAsPeopleDo) {
  EXPECT_TRUE(natural_less("slice2", "slice10"));
  EXPECT_TRUE(natural_less("a/slice2.tif", "a/slice10.tif"));
  EXPECT_TRUE(natural_less("s99999999999999999999998", "s99999999999999999999999"));
  EXPECT_TRUE(natural_less("s1x2", "s1x10"));
  EXPECT_TRUE(natural_less("slice", "slice1"));
  EXPECT_TRUE(natural_less("s007", "s8"));
  EXPECT_TRUE(natural_less("s01", "s1") != natural_less("s1", "s01"));
  EXPECT_FALSE(natural_less("s1", "s1"));
}

TEST(TiffReader, ReadsEverySampleTypeInStripsAndTilesAndBothByteOrders) {
  for (const std::string mode : {"wl", "wb", "w8", "w8b"}) {
    for (std::uint32_t tile : {0u, 16u}) {
      for (int format : {SAMPLEFORMAT_UINT, SAMPLEFORMAT_INT, SAMPLEFORMAT_IEEEFP}) {
        for (int bits : {8, 16, 32, 64}) {
          if (format == SAMPLEFORMAT_IEEEFP && bits < 32) continue;
          TiffSpec spec;
          spec.width = 21;
          spec.height = 3;
          spec.pages = 2;
          spec.mode = mode;
          spec.tile = tile;
          spec.format = format;
          spec.bits = bits;
          const Volume volume = read_spec(spec);
          EXPECT_EQ(volume.samples(), counting_samples(126)) << mode << " " << format << " " << bits;
          EXPECT_EQ(volume.header().format, "TIFF");
        }
      }
    }
  }
}

TEST(TiffReader, ReadsEveryLosslessCompressionOfThisLibtiff) {
  for (int compression : {COMPRESSION_LZW, COMPRESSION_PACKBITS, COMPRESSION_DEFLATE, COMPRESSION_ADOBE_DEFLATE,
                          COMPRESSION_LZMA, COMPRESSION_ZSTD, COMPRESSION_LERC}) {
    if (!TIFFIsCODECConfigured(static_cast<std::uint16_t>(compression))) continue;
    for (int bits : {8, 16, 32}) {
      for (int predictor : {0, 2}) {
        const bool can_predict = compression != COMPRESSION_PACKBITS && compression != COMPRESSION_LERC;
        if (predictor != 0 && !can_predict) continue;
        TiffSpec spec;
        spec.compression = compression;
        spec.bits = bits;
        spec.predictor = predictor;
        EXPECT_EQ(read_spec(spec).samples(), counting_samples(60)) << compression << " " << bits;
      }
    }
  }
  TiffSpec spec;
  spec.compression = COMPRESSION_ADOBE_DEFLATE;
  spec.format = SAMPLEFORMAT_IEEEFP;
  spec.bits = 32;
  spec.predictor = 3;
  EXPECT_EQ(read_spec(spec).samples(), counting_samples(60));
}

TEST(TiffReader, ReadsGreyJpegAndLogLuminanceNearly) {
  TiffSpec spec;
  spec.width = spec.height = 16;
  spec.pages = 1;
  spec.rows_per_strip = 16;
  spec.compression = COMPRESSION_JPEG;
  if (!TIFFIsCODECConfigured(COMPRESSION_JPEG)) GTEST_SKIP();
  const std::vector<float> samples = read_spec(spec).samples();
  for (int n = 0; n < 256; ++n) EXPECT_NEAR(samples[n], n, 12);
}

TEST(TiffReader, ReadsMasksOfOneToFourBitsAndFaxCompression) {
  for (int bits : {1, 2, 4}) {
    TiffSpec spec;
    spec.bits = bits;
    const std::vector<float> samples = read_spec(spec).samples();
    for (int n = 0; n < 60; ++n) EXPECT_EQ(samples[n], n & ((1 << bits) - 1));
  }
  for (int compression : {COMPRESSION_CCITTRLE, COMPRESSION_CCITTFAX3, COMPRESSION_CCITTFAX4}) {
    TiffSpec spec;
    spec.bits = 1;
    spec.compression = compression;
    const std::vector<float> samples = read_spec(spec).samples();
    for (int n = 0; n < 60; ++n) EXPECT_EQ(samples[n], n & 1) << compression;
  }
}

TEST(TiffReader, InvertsMinIsWhiteOfIntegers) {
  TiffSpec spec;
  spec.photometric = PHOTOMETRIC_MINISWHITE;
  EXPECT_EQ(read_spec(spec).value(1, 0, 0), 254);
  spec.bits = 16;
  EXPECT_EQ(read_spec(spec).value(1, 0, 0), 65534);
  spec.format = SAMPLEFORMAT_INT;
  EXPECT_EQ(read_spec(spec).value(1, 0, 0), -2);
  spec.bits = 1;
  spec.format = SAMPLEFORMAT_UINT;
  EXPECT_EQ(read_spec(spec).value(0, 0, 0), 1);
}

TEST(TiffReader, TakesSpacingFromTheOptionFirst) {
  TiffSpec spec;
  spec.resolution_x = spec.resolution_y = 100;
  spec.resolution_unit = RESUNIT_CENTIMETER;
  ReadVolumeOptions options;
  options.spacing = Vector3{0.5, 0.6, 0.7};
  EXPECT_EQ(read_spec(spec, options).header().spacing(), (Vector3{0.5, 0.6, 0.7}));
  options.spacing = Vector3{0.5, -0.6, 0.7};
  EXPECT_THROW(read_spec(spec, options), OptionError);
}

TEST(TiffReader, TakesSpacingFromTheResolutionTags) {
  TiffSpec spec;
  spec.resolution_x = 100;
  spec.resolution_y = 50;
  spec.resolution_unit = RESUNIT_CENTIMETER;
  const Volume volume = read_spec(spec);
  EXPECT_NEAR(volume.header().spacing().x, 0.1, 1e-7);
  EXPECT_NEAR(volume.header().spacing().y, 0.2, 1e-7);
  EXPECT_TRUE(warns(volume, "between slices"));
  spec.resolution_unit = RESUNIT_INCH;
  spec.resolution_x = spec.resolution_y = 254;
  EXPECT_NEAR(read_spec(spec).header().spacing().x, 0.1, 1e-7);
  spec.resolution_x = spec.resolution_y = 72;
  EXPECT_TRUE(warns(read_spec(spec), "looks like a default"));
  spec.resolution_unit = RESUNIT_NONE;
  EXPECT_EQ(read_spec(spec).header().spacing(), (Vector3{1, 1, 1}));
  EXPECT_TRUE(warns(read_spec(spec), "1 mm assumed"));
}

TEST(TiffReader, TakesSpacingOriginAndCalibrationFromImageJ) {
  TiffSpec spec;
  spec.resolution_x = spec.resolution_y = 2;
  spec.resolution_unit = RESUNIT_NONE;
  spec.description =
      "ImageJ=1.53\nimages=3\nslices=3\nunit=micron\nspacing=5.0\nxorigin=4\ncf=0\nc0=-32768.0\nc1=1.0\n";
  const Volume volume = read_spec(spec);
  EXPECT_NEAR(volume.header().spacing().x, 0.0005, 1e-12);
  EXPECT_NEAR(volume.header().spacing().z, 0.005, 1e-12);
  EXPECT_NEAR(volume.header().index_to_world({4, 0, 0}).x, 0, 1e-12);
  EXPECT_EQ(volume.value(1, 0, 0), -32767);
  spec.description = "ImageJ=1.53\nimages=3\nslices=3\nunit=furlong\nspacing=5.0\n";
  EXPECT_TRUE(warns(read_spec(spec), "furlong"));
}

TEST(TiffReader, ReadsImageJsLargeStacksOfOnePage) {
  for (const std::string mode : {"wl", "wb"}) {
    TiffSpec one;
    one.pages = 1;
    one.bits = 16;
    one.rows_per_strip = 4;
    one.mode = mode;
    one.description = "ImageJ=1.53\nimages=3\nslices=3\n";
    const TempFolder folder;
    const fs::path path = write_tiff_file(folder / "stack.tif", one);
    // libtiff puts samples before the directory: ImageJ, after it. Move them to the end.
    std::string bytes = read_file(path);
    const bool big = mode == "wb";
    const auto put = [&](std::size_t at, std::uint32_t value) { bytes.replace(at, 4, bytes_of(value, big)); };
    const std::uint32_t start = static_cast<std::uint32_t>(bytes.size());
    const std::string tag = bytes_of<std::uint16_t>(TIFFTAG_STRIPOFFSETS, big) + bytes_of<std::uint16_t>(4, big);
    const std::size_t entry = bytes.rfind(tag);
    ASSERT_NE(entry, std::string::npos);
    put(entry + 8, start);
    std::vector<std::uint16_t> samples;
    for (int n = 0; n < 60; ++n) samples.push_back(static_cast<std::uint16_t>(n));
    bytes += bytes_of_all(samples, big);
    EXPECT_EQ(read_volume(write_file(folder / "large.tif", bytes)).samples(), counting_samples(60));
    bytes.pop_back();
    EXPECT_NE(read_error(write_file(folder / "cut.tif", bytes)).find("truncated"), std::string::npos);
  }
}

TEST(TiffReader, SelectsAChannelAndFrameOfAHyperstack) {
  TiffSpec spec;
  spec.width = spec.height = 1;
  spec.pages = 12;
  spec.description = "ImageJ=1.53\nimages=12\nchannels=2\nslices=3\nframes=2\n";
  ReadVolumeOptions options;
  options.volume_index = 3;  // second channel, second frame
  EXPECT_EQ(read_spec(spec, options).samples(), (std::vector<float>{7, 9, 11}));
  options.volume_index = 4;
  EXPECT_THROW(read_spec(spec, options), InputError);
}

TEST(TiffReader, ReadsFoldersAndPatternsInNaturalOrder) {
  const TempFolder folder;
  TiffSpec spec;
  spec.pages = 1;
  for (int n : {10, 9, 2, 1}) {
    spec.first_value = 10 * n;
    write_tiff_file(folder / ("slice" + std::to_string(n) + (n == 9 ? ".TIFF" : ".tif")), spec);
  }
  write_file(folder / "notes.txt", "hello");
  write_file(folder / "._slice1.tif", "droppings");
  const Volume all = read_volume(folder.path());
  EXPECT_EQ(all.dims()[2], 4);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(all.value(0, 0, k), 10 * (std::array{1, 2, 9, 10})[k]);
  EXPECT_TRUE(warns(all, "1 entries"));
  const Volume some = read_volume(folder / "slice*.tif");
  EXPECT_EQ(some.dims()[2], 3);
  EXPECT_EQ(some.value(0, 0, 2), 100);
  EXPECT_NE(read_error(folder / "nothing*.tif").find("match"), std::string::npos);
}

TEST(TiffReader, LeavesThumbnailsOut) {
  const TempFolder folder;
  TIFF* tiff = TIFFOpen((folder / "stack.tif").c_str(), "w");
  TiffSpec spec, thumbnail;
  thumbnail.width = 2;
  thumbnail.photometric = PHOTOMETRIC_RGB;
  thumbnail.samples_per_pixel = 3;
  TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, FILETYPE_REDUCEDIMAGE);
  write_tiff_page(tiff, thumbnail, 0);
  write_tiff_page(tiff, spec, 0);
  write_tiff_page(tiff, spec, 1);
  TIFFClose(tiff);
  const Volume volume = read_volume(folder / "stack.tif");
  EXPECT_EQ(volume.samples(), counting_samples(40));
  EXPECT_TRUE(warns(volume, "thumbnail"));
}

TEST(TiffReader, RefusesColourAndOddSamplesWithAMend) {
  const TempFolder folder;
  const auto error = [&](const TiffSpec& spec) { return read_error(write_tiff_file(folder / "s.tif", spec)); };
  TiffSpec rgb;
  rgb.photometric = PHOTOMETRIC_RGB;
  rgb.samples_per_pixel = 3;
  EXPECT_NE(error(rgb).find("RGB"), std::string::npos);
  TiffSpec palette;
  palette.photometric = PHOTOMETRIC_PALETTE;
  EXPECT_NE(error(palette).find("palette"), std::string::npos);
  TiffSpec complex;
  complex.format = SAMPLEFORMAT_COMPLEXIEEEFP;
  complex.bits = 64;
  EXPECT_NE(error(complex).find("complex"), std::string::npos);
  TiffSpec two;
  two.samples_per_pixel = 2;
  EXPECT_NE(error(two).find("2 values per pixel"), std::string::npos);
}

TEST(TiffReader, RefusesSlicesOfDifferentSizesOrTypesNamingBoth) {
  const TempFolder folder;
  TiffSpec spec;
  spec.pages = 1;
  write_tiff_file(folder / "a1.tif", spec);
  TiffSpec wider = spec;
  wider.width = 6;
  write_tiff_file(folder / "a2.tif", wider);
  const std::string size_error = read_error(folder.path());
  EXPECT_NE(size_error.find("a1.tif is 5 x 4 uint8, a2.tif is 6 x 4 uint8"), std::string::npos) << size_error;
  TiffSpec deeper = spec;
  deeper.bits = 16;
  write_tiff_file(folder / "a2.tif", deeper);
  EXPECT_NE(read_error(folder.path()).find("a2.tif is 5 x 4 uint16"), std::string::npos);
}

TEST(TiffReader, RefusesEveryTruncation) {
  const TempFolder folder;
  for (int compression : {COMPRESSION_NONE, COMPRESSION_ADOBE_DEFLATE}) {
    TiffSpec spec;
    spec.compression = compression;
    const std::string bytes = read_file(write_tiff_file(folder / "s.tif", spec));
    for (std::size_t size = 1; size < bytes.size(); size += 3) {
      EXPECT_NE(read_error(write_file(folder / "cut.tif", bytes.substr(0, size))), "") << size;
    }
  }
}

}  // namespace
}  // namespace delvox
