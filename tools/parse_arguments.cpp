#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "config_json.h"
#include "console.h"
#include "delvox/core/errors.h"
#include "format.h"
#include "verbs.h"

namespace delvox::tools {
namespace {

constexpr std::size_t kNameWidth = 34;
constexpr std::size_t kDescriptionWidth = 82;

// CLI11 indents the lines of a description but does not break it.
class WrappingFormatter : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    std::string text;
    std::size_t width = 0;
    for (const std::string& word : split(CLI::Formatter::make_option_desc(option), ' ')) {
      if (!text.empty()) {
        const bool full = width + 1 + word.size() > kDescriptionWidth;
        text += full ? '\n' : ' ';
        width = full ? 0 : width + 1;
      }
      text += word;
      width += word.size();
    }
    return text;
  }
};

}  // namespace

bool parse_arguments(CLI::App& app, const Arguments& arguments) {
  app.set_version_flag("--version", "delvox " DELVOX_VERSION, "Print the version");
  const auto formatter = std::make_shared<WrappingFormatter>();
  formatter->column_width(kNameWidth);
  app.formatter(formatter);
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
  app.set_config("--config", "", "Read options from a JSON object, {\"size\": 2, ...}; flags win")
      ->type_name("FILE.json");
  app.config_formatter(std::make_shared<ConfigJson>());
  app.allow_config_extras(false);
}

}  // namespace delvox::tools
