#include "formula_flags.h"

#include <CLI/CLI.hpp>

#include "delvox/core/errors.h"
#include "format.h"

namespace delvox::tools {

void add_formula_options(CLI::App& app, std::string& implicit, std::string& box, const std::string& role) {
  auto* formula = app.add_option("--implicit", implicit,
                                 role + ": a formula in x, y, z; inside is where it is at most 0. + - * / ^, numbers, "
                                        "pi, e, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, log, sqrt, "
                                        "abs, min, max");
  formula->type_name("FORMULA");
  auto* where = app.add_option("--box", box,
                               "Where --implicit is looked at, mm, as --box=-2:2,-2:2,-2:2; its inside must not reach "
                               "the border of the box");
  where->needs(formula)->type_name("BOX");
  formula->needs(where);
}

Box3 parse_box(const std::string& text) {
  const auto fail = [&text](const std::string& cause) {
    throw OptionError("--box '" + text + "': " + cause + "; give --box=x0:x1,y0:y1,z0:z1");
  };
  const std::vector<std::string> ranges = split(text, ',');
  if (ranges.size() != 3) fail("there must be three ranges");
  Box3 box;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<std::string> ends = split(ranges[static_cast<std::size_t>(axis)], ':');
    if (ends.size() != 2) fail("a range is two numbers and a colon");
    box.min[axis] = parse_number(ends[0], "--box '" + text + "'");
    box.max[axis] = parse_number(ends[1], "--box '" + text + "'");
    if (!(box.min[axis] < box.max[axis])) fail("a range must go up");
  }
  return box;
}

}  // namespace delvox::tools
