#include "mesh_io/header_comment.h"

namespace delvox::mesh_io {
namespace {

constexpr std::string_view kOurs = "delvox mesh";
constexpr std::string_view kInMetres = " in m ";
constexpr std::string_view kIncomplete = "INCOMPLETE";

}  // namespace

std::string header_comment(const MeshInfo& info) {
  std::string result(kOurs);
  result += info.unit == LengthUnit::kMetre ? kInMetres : " in mm ";
  result += std::string("SPACE=") + to_string(info.frame);
  if (!info.complete) result += " " + std::string(kIncomplete) + " (stopped by a limit)";
  return result;
}

void read_header_comment(std::string_view comment, MeshInfo& info) {
  const auto contains = [&](std::string_view text) { return comment.find(text) != std::string_view::npos; };
  if (contains("SPACE=RAS")) info.frame = Frame::kRas;
  if (contains("SPACE=LPS")) info.frame = Frame::kLps;
  if (contains(kOurs) && contains(kInMetres)) info.unit = LengthUnit::kMetre;
  if (contains(kOurs) && contains(kIncomplete)) info.complete = false;
}

}  // namespace delvox::mesh_io
