#include "deck_json.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "delvox/core/errors.h"
#include "format.h"
#include "set_rules.h"

namespace delvox::tools {
namespace {

using nlohmann::json;

/// One object of a JSON file: every key must be asked for, every value have its type.
class Reader {
 public:
  Reader(const std::string& path, std::string place, const json& object)
      : path_(path), place_(std::move(place)), object_(object) {
    if (!object.is_object()) fail("must be an object");
  }

  [[noreturn]] void fail(const std::string& cause) const {
    throw OptionError(path_ + ": " + (place_.empty() ? "" : place_ + " ") + cause);
  }
  bool has(const char* key) {
    known_.emplace_back(key);
    return object_.contains(key);
  }
  double number(const char* key) { return as_number(value(key), key); }
  double number(const char* key, double otherwise) { return has(key) ? number(key) : otherwise; }
  std::string text(const char* key) {
    const json& v = value(key);
    if (!v.is_string()) fail(std::string("needs a text as \"") + key + "\"");
    return v.get<std::string>();
  }
  Vector3 vector(const char* key) {
    const json& v = value(key);
    if (!v.is_array() || v.size() != 3) fail(std::string("needs three numbers as \"") + key + "\"");
    return {as_number(v[0], key), as_number(v[1], key), as_number(v[2], key)};
  }
  /// Calls take(reader) for each object of a list; a list that is not there is empty.
  template <class Take>
  void each(const char* key, const Take& take) {
    if (!has(key)) return;
    const json& v = object_[key];
    if (!v.is_array()) fail(std::string("needs a list as \"") + key + "\"");
    for (std::size_t i = 0; i < v.size(); ++i) {
      Reader item(path_, std::string("\"") + key + "\"[" + std::to_string(i) + "]", v[i]);
      take(item);
      item.finish();
    }
  }
  const json& value(const char* key) {
    if (!has(key)) fail(std::string("needs \"") + key + "\"");
    return object_[key];
  }
  /// Throws if there are keys that nothing asked for.
  void finish() const {
    for (const auto& [key, ignored] : object_.items()) {
      if (std::find(known_.begin(), known_.end(), key) == known_.end()) fail("has the unknown key \"" + key + "\"");
    }
  }

 private:
  double as_number(const json& v, const char* key) const {
    if (!v.is_number()) fail(std::string("needs a number as \"") + key + "\"");
    return v.get<double>();
  }

  const std::string& path_;
  std::string place_;
  const json& object_;
  std::vector<std::string> known_;
};

json parse(const std::string& path) {
  std::ifstream stream(path);
  if (!stream) throw InputError(path + ": cannot be read; is there such a file?");
  try {
    return json::parse(stream);
  } catch (const json::exception& error) {
    throw InputError(path + ": is not JSON: " + one_line(error.what()));
  }
}

Material read_material(Reader& reader, const std::string& name) {
  check_name(name, "material " + name);
  Material material;
  material.name = name;
  material.youngs_modulus_mpa = reader.number("youngs_modulus_mpa");
  material.poisson_ratio = reader.number("poisson_ratio");
  material.density_kg_m3 = reader.number("density_kg_m3", 0);
  if (!(material.youngs_modulus_mpa > 0)) reader.fail("needs a \"youngs_modulus_mpa\" above 0");
  if (!(material.poisson_ratio > -1 && material.poisson_ratio < 0.5)) {
    reader.fail("needs a \"poisson_ratio\" above -1 and below 0.5");
  }
  if (!(material.density_kg_m3 >= 0)) reader.fail("needs a \"density_kg_m3\" of 0 or more");
  reader.finish();
  return material;
}

Material material_of(const std::string& path, const json& value, const std::map<std::string, Material>& known) {
  if (value.is_string()) {
    const auto found = known.find(value.get<std::string>());
    if (found != known.end()) return found->second;
    throw OptionError(path + ": no material " + value.dump() + "; give --materials with a file that has it");
  }
  Reader reader(path, "\"material\"", value);
  const std::string name = reader.text("name");
  return read_material(reader, name);
}

StaticDeck::Displacement read_support(Reader& reader) {
  StaticDeck::Displacement support;
  support.set = reader.text("set");
  const std::string axes = reader.has("axes") ? reader.text("axes") : "xyz";
  if (axes.empty() || axes.find_first_not_of("xyz") != std::string::npos)
    reader.fail("needs some of x, y, z as \"axes\"");
  for (char axis : axes) support.mm[static_cast<std::size_t>(axis - 'x')] = 0.0;
  return support;
}

StaticDeck::Displacement read_displacement(Reader& reader) {
  StaticDeck::Displacement displacement;
  displacement.set = reader.text("set");
  const char* keys[] = {"x_mm", "y_mm", "z_mm"};
  bool any = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!reader.has(keys[axis])) continue;
    displacement.mm[axis] = reader.number(keys[axis]);
    any = true;
  }
  if (!any) reader.fail("needs \"x_mm\", \"y_mm\" or \"z_mm\"");
  return displacement;
}

}  // namespace

DeckFile read_deck(const std::string& path, const std::map<std::string, Material>& known) {
  const json document = parse(path);
  Reader reader(path, "", document);
  DeckFile file;
  if (reader.has("material")) file.material.push_back(material_of(path, document["material"], known));
  reader.each("supports", [&](Reader& item) { file.deck.displacements.push_back(read_support(item)); });
  reader.each("displacements", [&](Reader& item) { file.deck.displacements.push_back(read_displacement(item)); });
  reader.each("pressures", [&](Reader& item) {
    StaticDeck::Pressure pressure;
    pressure.set = item.text("set");
    pressure.mpa = item.number("mpa");
    file.deck.pressures.push_back(pressure);
  });
  if (reader.has("gravity_m_s2")) file.deck.gravity_m_s2 = reader.vector("gravity_m_s2");
  reader.finish();
  if (file.deck.displacements.empty())
    reader.fail("has neither \"supports\" nor \"displacements\": nothing holds the body");
  return file;
}

std::map<std::string, Material> read_materials(const std::string& path) {
  const json document = parse(path);
  if (!document.is_object()) throw OptionError(path + ": must hold one object, {\"bone\": {...}, ...}");
  std::map<std::string, Material> materials;
  for (const auto& [name, value] : document.items()) {
    Reader reader(path, "\"" + name + "\"", value);
    materials[name] = read_material(reader, name);
  }
  return materials;
}

std::vector<std::string> sets_of(const StaticDeck& deck) {
  std::vector<std::string> names;
  for (const StaticDeck::Displacement& displacement : deck.displacements) names.push_back(displacement.set);
  for (const StaticDeck::Pressure& pressure : deck.pressures) names.push_back(pressure.set);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace delvox::tools
