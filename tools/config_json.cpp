#include "config_json.h"

#include <nlohmann/json.hpp>

#include "delvox/core/errors.h"
#include "format.h"

namespace delvox::tools {
namespace {

using nlohmann::json;

std::string scalar(const std::string& key, const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean() || value.is_number()) return value.dump();
  throw OptionError("--config: \"" + key + "\": expected a string, number, boolean or an array of these");
}

}  // namespace

std::string ConfigJson::to_config(const CLI::App*, bool, bool, std::string) const {
  throw OptionError("--config: files are only read");
}

std::vector<CLI::ConfigItem> ConfigJson::from_config(std::istream& input) const {
  json document;
  try {
    document = json::parse(input);
  } catch (const json::exception& error) {
    throw OptionError("--config: the file is not JSON: " + one_line(error.what()));
  }
  if (!document.is_object()) throw OptionError("--config: the file must hold one JSON object, {\"size\": 2, ...}");
  std::vector<CLI::ConfigItem> items;
  for (const auto& [key, value] : document.items()) {
    CLI::ConfigItem item;
    item.name = key;
    if (value.is_array()) {
      for (const json& element : value) item.inputs.push_back(scalar(key, element));
    } else {
      item.inputs.push_back(scalar(key, value));
    }
    items.push_back(std::move(item));
  }
  return items;
}

}  // namespace delvox::tools
