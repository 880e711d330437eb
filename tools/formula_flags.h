#pragma once

#include <string>

#include "delvox/core/geometry.h"

namespace CLI {
class App;
}

namespace delvox::tools {

/// --implicit and --box, each of which needs the other; `role` begins the help text of the first.
void add_formula_options(CLI::App& app, std::string& implicit, std::string& box, const std::string& role);

/// The box that "x0:x1,y0:y1,z0:z1" spells. Throws OptionError that names --box.
Box3 parse_box(const std::string& text);

}  // namespace delvox::tools
