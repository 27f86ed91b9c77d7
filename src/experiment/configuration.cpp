// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/configuration.h"

namespace dcnn {
namespace {

Json read_file_or_empty(const ConfigurationFlags& flags) {
  if (!flags.file) return Json::object();
  Json json = read_json(*flags.file, Exit::kUsage);
  require(json.is_object(), Exit::kUsage, flags.file->string(), ": must be a JSON object");
  return json;
}

/// The system description named by the flag or, relative to the configuration's folder, by its key;
/// an object in its place is taken as it is.
System find_system(const ConfigurationFlags& flags, const Json& given, const std::string& where) {
  if (flags.system) return read_system(*flags.system);
  if (!given.contains("system") || given["system"].is_null()) return {};
  const Json& value = given["system"];
  if (value.is_object()) return parse_system(value, where);
  require(value.is_string(), Exit::kUsage, where, ": key 'system' must be a file name");
  const auto folder = flags.file ? flags.file->parent_path() : std::filesystem::path();
  return read_system(folder / value.get<std::string>());
}

std::string text_at(const Json& json, const char* key, const std::string& fallback,
                    const std::string& where) {
  if (!json.contains(key)) return fallback;
  require(json[key].is_string(), Exit::kUsage, where, ": key '", key, "' must be a word");
  return json[key].get<std::string>();
}

Json flag_patch(const ConfigurationFlags& flags) {
  Json patch = Json::object();
  if (flags.epochs) patch["training"]["epochs"] = *flags.epochs;
  if (flags.seed) patch["seed"] = *flags.seed;
  if (flags.online) patch["features"]["derivative"]["kind"] = "sg_causal";
  return patch;
}

/// With a file that names an order for another estimator, --online keeps its window and takes its
/// own order.
void drop_foreign_order(Json& json, const ConfigurationFlags& flags) {
  if (flags.online) json["features"]["derivative"].erase("order");
}

}  // namespace

Json merged(Json under, const Json& over) {
  if (!under.is_object() || !over.is_object()) return over;
  for (const auto& [key, value] : over.items()) {
    under[key] = under.contains(key) ? merged(under[key], value) : value;
  }
  return under;
}

Configuration resolve(const ConfigurationFlags& flags) {
  Configuration result;
  Json given = read_file_or_empty(flags);
  result.where = flags.file ? flags.file->string() : "command line";
  Options as_given(given, result.where, Exit::kUsage);
  for (const char* section : {"features", "map", "model", "training", "noise"}) {
    as_given.child(section);  // what is none is named before presets cover it
  }
  const Json model_section = given.value("model", Json::object());
  const auto name = flags.model.value_or(text_at(model_section, "name", "dcnn", result.where));
  const auto preset = flags.preset.value_or(text_at(given, "preset", "standard", result.where));
  result.kind = &model_kind(name, Exit::kUsage);
  result.system = find_system(flags, given, result.where);
  const bool axes = result.system.kind == System::Kind::kAxes;

  given = merged(given, {{"preset", preset}, {"model", {{"name", name}}}});
  if (axes) given["system"] = result.system.json;
  result.json = merged(merged(result.kind->preset(preset, axes), given), flag_patch(flags));
  drop_foreign_order(result.json, flags);

  Options options(result.json, result.where, Exit::kUsage);
  options.choice("preset", preset, kPresets);
  result.features = parse_features(options.child("features"), result.system);
  result.seed = options.get<std::uint64_t>("seed", 1);
  result.validation = options.child("training").number("validation", 0.15, 0.0, 0.9);
  for (const char* section : {"system", "map", "model", "noise"}) options.raw(section);
  options.finish();
  return result;
}

}  // namespace dcnn
