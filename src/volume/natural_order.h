#pragma once

#include <string_view>

namespace delvox {

/// Whether `a` comes before `b` as people count: runs of digits compare as numbers, so slice2 before slice10.
/// A strict order: names that differ only in leading zeros fall back to comparing bytes.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace delvox
