// SPDX-License-Identifier: Apache-2.0
#include "dcnn/import/recipe.h"

#include <algorithm>

#include "dcnn/core/options.h"

namespace dcnn {
namespace {

Json column_json(const ColumnRule& rule) {
  Json json = Json::object();
  json["to"] = rule.to;
  json["stream"] = rule.stream;
  json["channel"] = rule.channel;
  if (!rule.unit.empty()) json["unit"] = rule.unit;
  if (!rule.why.empty()) json["unit_known_by"] = rule.why;
  if (rule.wrap != 0.0) json["wrap"] = rule.wrap;
  if (rule.offset != 0.0) json["offset"] = rule.offset;
  if (rule.gain != 1.0) json["gain"] = rule.gain;
  return json;
}

ColumnRule parse_column(const Json& json, const std::string& where) {
  Options options(json, where, Exit::kUsage);
  ColumnRule rule;
  rule.to = options.get<std::string>("to");
  rule.stream = options.get<std::string>("stream");
  rule.channel = options.get<std::string>("channel");
  rule.unit = options.get("unit", std::string());
  rule.why = options.get("unit_known_by", std::string());
  rule.wrap = options.number("wrap", 0.0, 0.0, 1e300);
  rule.offset = options.get("offset", 0.0);
  rule.gain = options.get("gain", 1.0);
  options.finish();
  return rule;
}

Json clock_json(const ClockRule& rule) {
  Json json = Json::object();
  json["stream"] = rule.stream;
  json["kind"] = rule.kind;
  if (!rule.channel.empty()) json["channel"] = rule.channel;
  if (!rule.nanoseconds.empty()) json["nanoseconds"] = rule.nanoseconds;
  if (rule.kind == "column") json["unit"] = rule.unit;
  if (!rule.why.empty()) json["known_by"] = rule.why;
  if (rule.hz > 0.0) json["hz"] = rule.hz;
  if (rule.offset != 0.0) json["offset_s"] = rule.offset;
  return json;
}

ClockRule parse_clock(const Json& json, const std::string& where) {
  Options options(json, where, Exit::kUsage);
  ClockRule rule;
  rule.stream = options.get<std::string>("stream");
  rule.kind = options.choice("kind", "none", {"header", "receive", "column", "rate", "none"});
  rule.channel = options.get("channel", std::string());
  rule.nanoseconds = options.get("nanoseconds", std::string());
  rule.unit = options.get("unit", std::string("s"));
  rule.why = options.get("known_by", std::string());
  rule.hz = options.number("hz", 0.0, 0.0, 1e9);
  rule.offset = options.get("offset_s", 0.0);
  options.finish();
  if (rule.kind == "rate" && rule.hz <= 0.0) options.reject("hz", "must be above 0");
  return rule;
}

std::vector<double> numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector3d triple_of(Options& options, const std::string& key) {
  const auto list = options.get(key, std::vector<double>(3, 0.0));
  if (list.size() != 3) options.reject(key, "must be three numbers");
  return {list[0], list[1], list[2]};
}

OrientationRule parse_orientation(Options options) {
  OrientationRule rule;
  rule.kind = options.choice("kind", "",
                             {"", "euler", "quaternion", "matrix", "rotation-vector", "joints"});
  rule.order = options.get("order", std::string("ZYX"));
  rule.inverse = options.get("inverse", false);
  options.finish();
  return rule;
}

WrenchRule parse_wrench(Options options) {
  WrenchRule rule;
  rule.frame = options.choice("frame", "sensor", {"sensor", "base"});
  rule.turn = triple_of(options, "turn_rpy");
  rule.origin = triple_of(options, "origin_m");
  rule.zeroed = options.get("zeroed", false);
  rule.payload.mass = options.number("payload_kg", 0.0, 0.0, 1e6);
  rule.payload.com = triple_of(options, "payload_com_m");
  options.finish();
  return rule;
}

ArmRule parse_arm(Options options) {
  ArmRule rule;
  rule.urdf = options.get("urdf", std::string());
  rule.base = options.get("base", std::string());
  rule.link = options.get("link", std::string());
  options.finish();
  return rule;
}

TextDialect parse_text(Options options) {
  TextDialect text;
  text.separator = options.choice("separator", "", {"", ",", ";", "|", "tab", "space"});
  text.decimal = options.choice("decimal", "", {"", ".", ","});
  text.columns = options.get("columns", std::vector<std::string>());
  options.finish();
  return text;
}

}  // namespace

bool Recipe::names(const LogStream& log_stream, const std::string& channel) const {
  const bool column = std::any_of(columns.begin(), columns.end(), [&](const ColumnRule& rule) {
    return rule.stream == log_stream.name && rule.channel == channel;
  });
  return column || std::any_of(clocks.begin(), clocks.end(), [&](const ClockRule& rule) {
           return rule.stream == log_stream.name &&
                  (rule.channel == channel || rule.nanoseconds == channel);
         });
}

Json to_json(const Recipe& recipe) {
  Json json = Json::object();
  json["import"] = 1;
  json["files"] = recipe.files;
  Json text = Json::object();
  if (!recipe.text.separator.empty()) text["separator"] = recipe.text.separator;
  if (!recipe.text.decimal.empty()) text["decimal"] = recipe.text.decimal;
  if (!recipe.text.columns.empty()) text["columns"] = recipe.text.columns;
  if (!text.empty()) json["text"] = text;
  json["clock"] = recipe.clock;
  json["clocks"] = Json::array();
  for (const ClockRule& rule : recipe.clocks) json["clocks"].push_back(clock_json(rule));
  json["columns"] = Json::array();
  for (const ColumnRule& rule : recipe.columns) json["columns"].push_back(column_json(rule));
  if (!recipe.orientation.kind.empty()) {
    json["orientation"] = {{"kind", recipe.orientation.kind},
                           {"order", recipe.orientation.order},
                           {"inverse", recipe.orientation.inverse}};
  }
  json["wrench"] = {{"frame", recipe.wrench.frame},
                    {"turn_rpy", numbers(recipe.wrench.turn)},
                    {"origin_m", numbers(recipe.wrench.origin)}};
  if (recipe.wrench.zeroed) json["wrench"]["zeroed"] = true;
  if (recipe.wrench.payload.mass > 0.0) {
    json["wrench"]["payload_kg"] = recipe.wrench.payload.mass;
    json["wrench"]["payload_com_m"] = numbers(recipe.wrench.payload.com);
  }
  if (!recipe.arm.urdf.empty()) {
    json["arm"] = {{"urdf", recipe.arm.urdf}, {"base", recipe.arm.base}, {"link", recipe.arm.link}};
  }
  if (recipe.resample_hz != 0.0) json["resample_hz"] = recipe.resample_hz;
  return json;
}

Recipe parse_recipe(const Json& json, const std::string& where) {
  Options options(json, where, Exit::kUsage);
  Recipe recipe;
  if (options.get<int>("import") != 1) options.reject("import", "must be 1, this format's version");
  recipe.files = options.get("files", 1);
  if (recipe.files < 1 || recipe.files > 1000) options.reject("files", "must be 1 to 1000");
  recipe.text = parse_text(options.child("text"));
  recipe.clock = options.get("clock", std::string());
  const Json clocks = options.raw("clocks"), columns = options.raw("columns");
  if (!clocks.is_array()) options.reject("clocks", "must be a list");
  if (!columns.is_array()) options.reject("columns", "must be a list");
  for (const Json& rule : clocks) recipe.clocks.push_back(parse_clock(rule, where));
  for (const Json& rule : columns) recipe.columns.push_back(parse_column(rule, where));
  recipe.orientation = parse_orientation(options.child("orientation"));
  recipe.wrench = parse_wrench(options.child("wrench"));
  recipe.arm = parse_arm(options.child("arm"));
  recipe.resample_hz = options.get("resample_hz", 0.0);
  options.finish();
  return recipe;
}

Recipe read_recipe(const std::filesystem::path& path) {
  return parse_recipe(read_json(path, Exit::kUsage), path.string());
}

}  // namespace dcnn
