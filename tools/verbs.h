#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace delvox::tools {

/// What stands after the verb on the command line.
using Arguments = std::vector<std::string>;

/// One word of the command line: `delvox NAME ...`.
struct Verb {
  const char* name;
  const char* arguments;  ///< "VOLUME -o MESH", for the overview
  const char* summary;    ///< one line
  void (*run)(const Verb& verb, const Arguments& arguments);  ///< throws Error; returns when done
};

void run_info(const Verb& verb, const Arguments& arguments);
void run_surface(const Verb& verb, const Arguments& arguments);
void run_remesh(const Verb& verb, const Arguments& arguments);
void run_tet(const Verb& verb, const Arguments& arguments);
void run_check(const Verb& verb, const Arguments& arguments);
void run_convert(const Verb& verb, const Arguments& arguments);
void run_phantom(const Verb& verb, const Arguments& arguments);

/// Parses into what was bound to `app`. Returns false if help or the version was asked for, and printed.
/// Throws OptionError.
bool parse_arguments(CLI::App& app, const Arguments& arguments);

/// Adds --config FILE.json.
void add_config_option(CLI::App& app);

}  // namespace delvox::tools
