#include "check/report_builder.h"

#include <utility>

namespace delvox::check {

void ReportBuilder::put(Check check) {
  for (Check& existing : report_.checks) {
    if (existing.name == check.name) {
      existing = std::move(check);
      return;
    }
  }
  report_.checks.push_back(std::move(check));
}

namespace {

Check counted(const std::string& name, std::size_t count, const std::string& note) {
  Check check;
  check.name = name;
  check.status = count == 0 ? CheckStatus::kPassed : CheckStatus::kFailed;
  check.measured = static_cast<double>(count);
  check.bound = 0;
  check.violations = count;
  check.note = note;
  return check;
}

}  // namespace

void ReportBuilder::count(const std::string& name, const Tally& faults, const std::string& note) {
  Check check = counted(name, faults.count, note);
  if (faults.count > 0) check.where = faults.where;
  put(std::move(check));
}

void ReportBuilder::fault_of_all(const std::string& name, bool is_so, const std::string& note) {
  put(counted(name, is_so ? 1 : 0, is_so ? note : ""));
}

void ReportBuilder::bounded(const std::string& name, const Extreme& worst, const std::optional<double>& bound,
                            const std::string& unit, const std::string& note) {
  Check check;
  check.name = name;
  check.measured = worst.value;
  check.unit = unit;
  check.note = note;
  if (worst.any) check.where = worst.where;
  if (bound) {
    check.status = worst.violations == 0 ? CheckStatus::kPassed : CheckStatus::kFailed;
    check.bound = bound;
    check.violations = worst.violations;
  } else if (note.empty()) {
    check.note = "no bound promised";
  }
  put(std::move(check));
}

void ReportBuilder::not_applicable(const std::string& name, const std::string& note) {
  Check check;
  check.name = name;
  check.note = note;
  put(std::move(check));
}

}  // namespace delvox::check
