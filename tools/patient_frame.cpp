#include "patient_frame.h"

#include <CLI/CLI.hpp>

#include "format.h"

namespace delvox::tools {
namespace {

// The spelling of -x for a spelling of x; an empty one stands for a bound left out.
std::string negated(const std::string& text) {
  if (text.empty()) return text;
  if (text[0] == '-') return text.substr(1);
  return "-" + (text[0] == '+' ? text.substr(1) : text);
}

std::string joined(const std::vector<std::string>& pieces) {
  std::string text = pieces[0];
  for (std::size_t i = 1; i < pieces.size(); ++i) text += "," + pieces[i];
  return text;
}

}  // namespace

void add_frame_option(CLI::App& app, std::string& frame) {
  app.add_option("--frame", frame,
                 "Patient frame of what is written, and of points given by flags: ras or lps (default: the volume's "
                 "own; one that states none is taken to be in this). 3D Slicer takes a .vtu for lps")
      ->check(CLI::IsMember({"ras", "lps"}))
      ->type_name("FRAME");
}

FrameChange::FrameChange(Frame of_volume, const std::string& wanted) : target_(of_volume) {
  if (wanted.empty()) return;
  target_ = wanted == "ras" ? Frame::kRas : Frame::kLps;
  turns_ = of_volume != Frame::kUnknown && of_volume != target_;
}

void FrameChange::apply(Mesh& mesh) const {
  std::visit(
      [this](auto& m) {
        m.info.frame = target_;
        if (!turns_) return;
        for (Point3& p : m.points) p = (*this)(p);
      },
      mesh);
}

void FrameChange::apply(RunReport& report) const {
  for (Unmet& unmet : report.unmet) {
    if (unmet.where) unmet.where = (*this)(*unmet.where);
  }
}

void FrameChange::apply(SliverReport& report) const {
  for (UnmetTet& unmet : report.unmet) unmet.where = (*this)(unmet.where);
}

std::string FrameChange::iso_in_volume(const std::string& text) const {
  if (!turns_ || !text.starts_with("at:")) return text;
  std::vector<std::string> coordinates = split(text.substr(3), ',');
  for (std::size_t axis = 0; axis < 2 && axis < coordinates.size(); ++axis) {
    coordinates[axis] = negated(coordinates[axis]);
  }
  return "at:" + joined(coordinates);
}

std::string FrameChange::crop_in_volume(const std::string& text) const {
  if (!turns_ || !text.ends_with("mm")) return text;
  std::vector<std::string> ranges = split(text.substr(0, text.size() - 2), ',');
  for (std::size_t axis = 0; axis < 2 && axis < ranges.size(); ++axis) {
    const std::vector<std::string> bounds = split(ranges[axis], ':');
    if (bounds.size() == 2) ranges[axis] = negated(bounds[1]) + ":" + negated(bounds[0]);
  }
  return joined(ranges) + "mm";
}

}  // namespace delvox::tools
