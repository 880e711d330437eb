#include "delvox/mesh_io/read_samples.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "delvox/core/errors.h"
#include "delvox/mesh_io/write_mesh.h"
#include "mesh_io/mesh_io_support.h"

namespace delvox {
namespace {

using testing::file_bytes;
using testing::TemporaryFolder;
using testing::write_bytes;

class ReadSamples : public ::testing::Test {
 protected:
  SamplesFile read(const std::string& bytes, const std::string& field = {}, const std::string& name = "s.csv") {
    write_bytes(folder_ / name, bytes);
    return read_samples(folder_ / name, field);
  }

  /// One line that names the file and holds all of `words`.
  void expect_refused(const std::string& bytes, const std::vector<std::string>& words, const std::string& field = {},
                      const std::string& name = "s.csv") {
    try {
      read(bytes, field, name);
      ADD_FAILURE() << "read: " << bytes.substr(0, 80);
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 0) << text;
      EXPECT_NE(text.find(name), std::string::npos) << text;
      for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << text;
    }
  }

  TemporaryFolder folder_;
};

const std::vector<Point3> kPlaces{{0, 0, 0}, {1, 0, 0}, {0, 2.5, 0}, {0, 0, -1e-3}};
const std::vector<double> kValues{1, 2, -3, 4e5};

TEST_F(ReadSamples, EveryDialectOfTextGivesTheSameSamples) {
  const std::pair<const char*, const char*> dialects[] = {
      {"commas", "0,0,0,1\n1,0,0,2\n0,2.5,0,-3\n0,0,-1e-3,4e5\n"},
      {"no last line end", "0,0,0,1\n1,0,0,2\n0,2.5,0,-3\n0,0,-1e-3,4e5"},
      {"semicolons and blanks", "0; 0; 0; 1\n1 ;0;0;2\n0;2.5;0;-3\n0;0;-1e-3;4E5\n"},
      {"tabs", "0\t0\t0\t1\n1\t0\t0\t2\n0\t2.5\t0\t-3\n0\t0\t-1e-3\t4e+5\n"},
      {"blanks", "  0 0   0 1\n1 0 0 2  \n0\t2.5 0 -3\n0 0 -.001 400000\n"},
      {"comments and empty lines", "# made by hand\n\n0,0,0,1 # first\n1,0,0,2\n  \n0,2.5,0,-3\n#\n0,0,-1e-3,4e5\n"},
      {"DOS line ends", "x,y,z,value\r\n0,0,0,1\r\n1,0,0,2\r\n0,2.5,0,-3\r\n0,0,-1e-3,4e5\r\n"},
      {"byte order mark", "\xef\xbb\xbfx,y,z,value\n0,0,0,1\n1,0,0,2\n0,2.5,0,-3\n0,0,-1e-3,4e5\n"},
      {"plus signs", "+0,+0,0,+1\n+1,0,0,2\n0,+2.5,0,-3\n0,0,-1e-3,+4e5\n"},
      {"names in another order", "value;Z;Y;X\n1;0;0;0\n2;0;0;1\n-3;0;2.5;0\n4e5;-1e-3;0;0\n"},
      {"quotes", "\"x\",\"y\",\"z\",\"dose, Gy\"\n0,0,0,1\n\"1\",0,0,2\n0,2.5,0,-3\n0,0,-1e-3,4e5\n"},
      {"ParaView's", "\"dose\",\"Points:0\",\"Points:1\",\"Points:2\"\n1,0,0,0\n2,1,0,0\n-3,0,2.5,0\n4e5,0,0,-1e-3\n"},
      {"names of no axes", "east north up dose\n0 0 0 1\n1 0 0 2\n0 2.5 0 -3\n0 0 -1e-3 4e5\n"},
      {"a column more", "0,0,0,1,9\n1,0,0,2,9\n0,2.5,0,-3,9\n0,0,-1e-3,4e5,9\n"},
  };
  for (const auto& [name, text] : dialects) {
    const SamplesFile file = read(text);
    EXPECT_EQ(file.samples.points, kPlaces) << name;
    EXPECT_EQ(file.samples.values, kValues) << name;
    EXPECT_EQ(file.format, "CSV");
    EXPECT_EQ(file.merged, 0u);
  }
  EXPECT_EQ(read("x,y,z,dose\n0,0,0,1\n1,0,0,2\n0,1,0,3\n0,0,1,4\n").field, "dose");
}

TEST_F(ReadSamples, TheFieldChoosesAmongColumns) {
  const std::string text = "x,y,z,dose,error\n0,0,0,1,5\n1,0,0,2,6\n0,1,0,3,7\n0,0,1,4,8\n";
  EXPECT_EQ(read(text, "error").samples.values, (std::vector<double>{5, 6, 7, 8}));
  EXPECT_EQ(read(text, "dose").samples.values, (std::vector<double>{1, 2, 3, 4}));
  expect_refused(text, {"line 1", "--field", "'dose', 'error'"});
  expect_refused(text, {"'Dose'", "'dose', 'error'"}, "Dose");
  expect_refused(text, {"'x'"}, "x");
  expect_refused("0,0,0,1\n1,0,0,2\n0,1,0,3\n0,0,1,4\n", {"line 1", "no names", "dose"}, "dose");
  expect_refused("x,y,z\n0,0,0\n", {"no column of values"});
  // One named value needs no choice.
  EXPECT_EQ(read("x,y,z,t,value\n0,0,0,1,5\n1,0,0,2,6\n0,1,0,3,7\n0,0,1,4,8\n").field, "value");
}

TEST_F(ReadSamples, BadTextIsRefusedWithItsLine) {
  expect_refused("# nothing\n\n", {"no samples"});
  expect_refused("x,y,z,value\n", {"0 places"});
  expect_refused("0,0,0\n", {"line 1", "3 cells"});
  expect_refused("0,0,0,1\n1,0,0,2\n0,1,0,3\n", {"3 places", "four"});
  expect_refused("0,0,0,1\n1,0,0,2\n0,1,0,3\n0,0,1\n", {"line 4", "3 cells, the first line 4", "cut off"});
  expect_refused("0,0,0,1\n1,0,0,2,7\n", {"line 2", "5 cells"});
  expect_refused("x,y,z,value\n0,0,0,1\n\n1,0,zero,2\n", {"line 4", "'zero'"});
  expect_refused("0,0,0,1\n1,0,,2\n", {"line 2", "''"});
  expect_refused("0;0;0;1\n1,5;0;0;2\n", {"line 2", "'1,5'", "decimal points"});
  expect_refused("0 0 0 1\n1 0 0 0x10\n", {"line 2", "'0x10'"});
  expect_refused("0,0,0,1\n1,0,0,nan\n0,1,0,3\n0,0,1,4\n", {"line 2", "not finite"});
  expect_refused("0,0,0,1\n1,inf,0,1\n0,1,0,3\n0,0,1,4\n", {"line 2", "not finite"});
  expect_refused("0,0,0,1\n1,1e400,0,1\n0,1,0,3\n0,0,1,4\n", {"line 2", "not finite"});
  expect_refused("0,0,0,1\n1,1e20,0,1\n0,1,0,3\n0,0,1,4\n", {"line 2", "1e+20"});
  expect_refused("0,0,0,1\n1,1,0,-1e50\n0,1,0,3\n0,0,1,4\n", {"line 2", "-1e+50"});
  expect_refused("1e14,0,0,1\n1e14,1,0,-1\n1e14,0,1,3\n100000000000001,0,1,4\n", {"too far from the origin"});
  expect_refused(std::string("\0\1\2\3garbage\n", 12), {"line 1"});
  EXPECT_EQ(read("0,0,0,1e-400\n1,0,0,2\n0,1,0,3\n0,0,1,4\n").samples.values[0], 0);
}

TEST_F(ReadSamples, EqualSamplesMergeAndTwoValuesInOnePlaceAreRefused) {
  const SamplesFile file = read("0,0,0,1\n1,0,0,2\n0,1,0,3\n-0,0,0,1\n0,0,1,4\n1,0,0,2\n");
  EXPECT_EQ(file.merged, 2u);
  EXPECT_EQ(file.samples.values, (std::vector<double>{1, 2, 3, 4}));
  expect_refused("x y z v\n0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n1 0 0 2.5\n",
                 {"line 3 and line 6", "(1, 0, 0)", "2 and 2.5"});
}

std::string with_point_data(std::string vtu, const std::string& arrays) {
  const std::string tag = "<PointData";
  const std::size_t at = vtu.find('>', vtu.find(tag)) + 1;
  return vtu.insert(at, arrays);
}

std::string ascii_array(const std::string& name, std::size_t count) {
  std::string text = "<DataArray type=\"Float64\" Name=\"" + name + "\" format=\"ascii\">";
  for (std::size_t i = 0; i < count; ++i) text += " " + std::to_string(i * i);
  return text + "</DataArray>";
}

// What `delvox tet` writes (binary, compressed), with an array of values put in by hand.
TEST_F(ReadSamples, PointsOfOurVtuFilesWithAnArrayOnThemAreSamples) {
  TetMesh mesh = testing::awkward_tets();
  write_mesh(mesh, folder_ / "mesh.vtu");
  const std::string bytes = file_bytes(folder_ / "mesh.vtu");
  const std::string one = with_point_data(bytes, ascii_array("dose", 5));
  for (const char* field : {"", "dose"}) {
    const SamplesFile file = read(one, field, "s.vtu");
    EXPECT_EQ(file.samples.points, mesh.points);
    EXPECT_EQ(file.samples.values, (std::vector<double>{0, 1, 4, 9, 16}));
    EXPECT_EQ(file.samples.frame, Frame::kLps);
    EXPECT_EQ(file.format, "VTU");
    EXPECT_EQ(file.field, "dose");
  }
  EXPECT_EQ(read(one, "on_surface", "s.vtu").samples.values, (std::vector<double>{1, 0, 1, 1, 1}));
  const std::string two = with_point_data(one, ascii_array("time", 5));
  expect_refused(two, {"--field", "'time', 'dose'"}, "", "s.vtu");
  EXPECT_EQ(read(two, "time", "s.vtu").field, "time");
  expect_refused(two, {"'heat'", "'time', 'dose'"}, "heat", "s.vtu");
  expect_refused(bytes, {"no array of numbers on its points"}, "", "s.vtu");
  expect_refused(with_point_data(bytes, ascii_array("dose", 4)), {"4 numbers for 5 points"}, "", "s.vtu");
  expect_refused(one.substr(0, one.size() / 2), {}, "", "s.vtu");
  mesh.info.unit = LengthUnit::kMetre;
  write_mesh(mesh, folder_ / "mesh.vtu");
  const SamplesFile metres =
      read(with_point_data(file_bytes(folder_ / "mesh.vtu"), ascii_array("dose", 5)), "", "s.vtu");
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(distance(metres.samples.points[i], mesh.points[i]), 0, 1e-9);
}

TEST_F(ReadSamples, InlineAndAppendedBase64AndRawDataAreRead) {
  // Four Float64 points of (0,0,0), (1,0,0), (0,1,0), (0,0,1) and values 1 to 4; headers of UInt32.
  const auto piece = [](const std::string& points, const std::string& values, const std::string& tail) {
    return "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"><UnstructuredGrid>"
           "<Piece NumberOfPoints=\"4\" NumberOfCells=\"0\"><PointData><DataArray type=\"Float32\" Name=\"v\" " +
           values + "</DataArray></PointData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" " + points +
           "</DataArray></Points></Piece></UnstructuredGrid>" + tail + "</VTKFile>\n";
  };
  const std::string points = "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1";
  const std::string base64 = "EAAAAAAAgD8AAABAAABAQAAAgEA=";
  const std::string raw("\x10\0\0\0\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\x80\x40", 20);
  for (const std::string& text : {piece(points, "format=\"binary\">" + base64, ""),
                                  piece(points, "format=\"appended\" offset=\"0\">",
                                        "<AppendedData encoding=\"base64\">_" + base64 + "</AppendedData>"),
                                  piece(points, "format=\"appended\" offset=\"0\">",
                                        "<AppendedData encoding=\"raw\">_" + raw + "</AppendedData>")}) {
    const SamplesFile file = read(text, "v", "s.vtu");
    EXPECT_EQ(file.samples.values, (std::vector<double>{1, 2, 3, 4}));
    EXPECT_EQ(file.samples.points[3], (Point3{0, 0, 1}));
  }
}

}  // namespace
}  // namespace delvox
