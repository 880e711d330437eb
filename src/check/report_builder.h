#pragma once

#include <string>

#include "check/element_quality.h"
#include "check/surface_topology.h"

namespace delvox::check {

/// Appends checks to a report. A later check of the same name replaces an earlier one: the volume knows better.
class ReportBuilder {
 public:
  explicit ReportBuilder(CheckReport& report) : report_(report) {}

  /// Something that must not occur at all.
  void count(const std::string& name, const Tally& faults, const std::string& note = {});
  /// Something that must not be so, of the mesh as a whole: there is no place to it. `note` for when it is.
  void fault_of_all(const std::string& name, bool is_so, const std::string& note);
  /// A worst value against its bound; without a bound it is reported but does not apply.
  void bounded(const std::string& name, const Extreme& worst, const std::optional<double>& bound,
               const std::string& unit, const std::string& note = {});
  void not_applicable(const std::string& name, const std::string& note);

 private:
  void put(Check check);
  CheckReport& report_;
};

}  // namespace delvox::check
