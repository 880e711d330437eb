#include "solvers/calculix.h"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "delvox/meshing/deltetsurf.h"
#include "delvox/meshing/remove_slivers.h"
#include "delvox/oracle/implicit_oracle.h"

namespace delvox::test {
namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

bool has_calculix() {
  return std::system("which ccx >/dev/null 2>&1") == 0;
}

Calculix::Calculix() {
  std::string name = (std::filesystem::temp_directory_path() / "delvox_ccx_XXXXXX").string();
  folder_ = ::mkdtemp(name.data());
}

Calculix::~Calculix() {
  std::filesystem::remove_all(folder_);
}

void Calculix::append(const std::string& text) const {
  std::ofstream(deck(), std::ios::app) << text;
}

void Calculix::request(const std::string& text) const {
  const std::string end = "*END STEP\n", all = content(deck());
  std::ofstream(deck()) << all.substr(0, all.rfind(end)) << text << end;
}

std::string Calculix::run() const {
  const std::string command = "cd '" + folder_.string() + "' && OMP_NUM_THREADS=1 timeout 300 ccx -i job > out 2>&1";
  if (std::system(command.c_str()) != 0) return "ccx failed: " + content(folder_ / "out");
  const std::string out = content(folder_ / "out");
  for (const char* word : {"*ERROR", "ERROR", "error in", "nonpositive jacobian"}) {
    if (out.find(word) != std::string::npos) return out.substr(out.find(word), 500);
  }
  return out.find("Job finished") == std::string::npos ? "ccx did not finish" : "";
}

std::vector<std::vector<double>> Calculix::rows(std::size_t columns) const {
  std::vector<std::vector<double>> result;
  std::ifstream stream(folder_ / "job.dat");
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::vector<double> row;
    for (double value; words >> value;) row.push_back(value);
    if (words.eof() && row.size() == columns) result.push_back(std::move(row));
  }
  return result;
}

std::unique_ptr<SmoothOracle> ball(double radius, double inner) {
  // The nearer of the two spheres: smooth but half way between, where there is no surface.
  const double middle = 0.5 * (radius + inner), half = 0.5 * (radius - inner);
  ImplicitFunction f;
  f.value = [=](const Point3& p) { return inner > 0 ? std::abs(norm(p) - middle) - half : norm(p) - radius; };
  f.gradient = [=](const Point3& p) {
    const double r = norm(p), sign = inner > 0 && r < middle ? -1 : 1;
    return r > 0 ? (sign / r) * p : Vector3{1, 0, 0};
  };
  const double reach = 1.2 * radius;
  f.box = {{-reach, -reach, -reach}, {reach, reach, reach}};
  f.resolution = 0.1 * radius;
  return make_implicit_oracle(f);
}

TetMesh tets_of(const Oracle& oracle, double size) {
  DelTetSurfOptions options;
  options.surface.size = size;
  options.tets.cell_size = size;
  RunReport report;
  TetMesh mesh = deltetsurf(oracle, options, report);
  remove_slivers(mesh, oracle, {15, options.surface, options.tets, {}}, report);
  return mesh;
}

std::string number_of(std::uint32_t point) {
  return std::to_string(point + 1);
}

}  // namespace delvox::test
