#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "config_json.h"
#include "console.h"
#include "delvox/core/errors.h"
#include "format.h"
#include "verbs.h"

namespace delvox::tools {

bool parse_arguments(CLI::App& app, const Arguments& arguments) {
  app.set_version_flag("--version", "delvox " DELVOX_VERSION, "Print the version");
  app.get_formatter()->column_width(34);
  try {
    app.parse(Arguments(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    write_stdout(app.help());
    return false;
  } catch (const CLI::CallForVersion& version) {
    write_stdout(std::string(version.what()) + "\n");
    return false;
  } catch (const CLI::FileError& error) {
    throw OptionError("--config: " + one_line(error.what()));
  } catch (const CLI::ConfigError& error) {
    throw OptionError("--config: " + one_line(error.what()) + "; see " + app.get_name() + " --help for what there is");
  } catch (const CLI::ParseError& error) {
    throw OptionError(one_line(error.what()) + "; see " + app.get_name() + " --help");
  }
  return true;
}

void add_config_option(CLI::App& app) {
  app.set_config("--config", "", "Read options from a JSON object, {\"size\": 2, ...}; flags win");
  app.config_formatter(std::make_shared<ConfigJson>());
  app.allow_config_extras(false);
}

}  // namespace delvox::tools
