#include "mesh_io/region_name.h"

namespace delvox::mesh_io {

std::optional<std::int64_t> region_number(const Source& source, const std::string& name) {
  constexpr std::string_view kPrefix = "REGION_";
  if (!upper_case(name).starts_with(kPrefix)) return std::nullopt;
  const std::string_view number = std::string_view(name).substr(kPrefix.size());
  const std::size_t sign = number.starts_with('-') ? 1 : 0;
  if (number.size() <= sign || number.find_first_not_of("0123456789", sign) != std::string_view::npos) {
    return std::nullopt;
  }
  return parse_integer(source, number);
}

}  // namespace delvox::mesh_io
