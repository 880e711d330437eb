#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "delvox/core/mesh.h"
#include "delvox/oracle/oracle.h"

namespace delvox::test {

/// Whether ccx (Debian: calculix-ccx) is installed.
bool has_calculix();

/// A folder with a deck in it, removed at the end.
class Calculix {
 public:
  Calculix();
  ~Calculix();
  Calculix(const Calculix&) = delete;
  Calculix& operator=(const Calculix&) = delete;

  /// Where the deck is to be written.
  std::filesystem::path deck() const { return folder_ / "job.inp"; }
  /// Appends text to the deck.
  void append(const std::string& text) const;
  /// Puts requests for printed results before the end of the deck's step.
  void request(const std::string& text) const;
  /// Runs ccx on it; what it complains of, or "" if it says nothing of errors and ends well.
  std::string run() const;
  /// Tables of numbers printed to job.dat: all rows of all tables, each as long as `columns`; other rows are passed
  /// over.
  std::vector<std::vector<double>> rows(std::size_t columns) const;

 private:
  std::filesystem::path folder_;
};

/// The ball {|p| < radius}, or the shell {inner < |p| < radius} if inner > 0.
std::unique_ptr<SmoothOracle> ball(double radius, double inner = 0);

/// Its tets at a size, of first order, without slivers as those of the program.
TetMesh tets_of(const Oracle& oracle, double size);

/// Names of nodes by number, for requests: 1 for point 0.
std::string number_of(std::uint32_t point);

}  // namespace delvox::test
