// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/system.h"

#include <cctype>
#include <set>

#include "dcnn/core/options.h"

namespace dcnn {
namespace {

constexpr double kMaxHz = 1e6;

/// Where the reading's unit does not tell whether an axis turns, the name of its position may.
std::string default_position_unit(const Axis& axis) {
  if (axis.unit == "N") return "m";
  if (axis.unit == "N*m" || axis.unit == "A") return "rad";
  std::string name;
  for (const unsigned char c : axis.position) name += static_cast<char>(std::tolower(c));
  const auto says = [&](const char* word) { return name.find(word) != std::string::npos; };
  const bool angle = says("angle") || says("theta") || says("roll") || says("pitch") ||
                     says("yaw") || name.ends_with("rad");
  return angle || name.starts_with("q_") ? "rad" : "";
}

Axis parse_axis(const Json& json, const std::string& where) {
  Options options(json, where, Exit::kData);
  Axis axis;
  axis.name = options.get<std::string>("name");
  axis.measured = options.get<std::string>("measured");
  axis.unit = options.get<std::string>("unit", "");
  axis.position = options.get<std::string>("position", "");
  axis.velocity = options.get<std::string>("velocity", "");
  axis.acceleration = options.get<std::string>("acceleration", "");
  axis.simulated = options.get<std::string>("simulated", "");
  axis.signals = options.get<std::vector<std::string>>("signals", {});
  axis.base = options.get<std::vector<std::string>>("base", {});
  axis.has_base = options.has("base");
  axis.position_unit = options.get<std::string>("position_unit", default_position_unit(axis));
  axis.scale = options.number("scale", 1.0, -1e12, 1e12);
  if (axis.name.empty()) options.reject("name", "is empty");
  if (axis.measured.empty()) options.reject("measured", "is empty: name the measured column");
  if (axis.scale == 0.0) options.reject("scale", "is zero");
  if (axis.has_base && !axis.simulated.empty()) {
    options.reject("base", "excludes 'simulated': give one of them");
  }
  options.finish();
  return axis;
}

std::vector<Axis> parse_axes(const Json& json, const std::string& where) {
  require(json.is_array() && !json.empty(), Exit::kData, where,
          ": key 'axes' must be a list of at least one axis");
  std::vector<Axis> axes;
  std::set<std::string> names;
  for (const Json& entry : json) {
    const std::string place = where + ": axes[" + std::to_string(axes.size()) + "]";
    axes.push_back(parse_axis(entry, place));
    require(names.insert(axes.back().name).second, Exit::kData, place, ": the name '",
            axes.back().name, "' is there twice; rename one axis");
  }
  return axes;
}

}  // namespace

System parse_system(const Json& json, const std::string& where) {
  if (json.is_null()) return {};
  Options options(json, where, Exit::kData);
  System system;
  const bool axes = options.choice("kind", "wrist", {"wrist", "axes"}) == "axes";
  system.kind = axes ? System::Kind::kAxes : System::Kind::kWrist;
  system.resample_hz = options.number("resample_hz", 0.0, 0.0, kMaxHz);
  system.lowpass_hz = options.number("lowpass_hz", 0.0, 0.0, kMaxHz);
  if (axes) {
    system.axes = parse_axes(options.raw("axes"), where);
    system.arm = options.raw("arm");
    if (!system.arm.is_null() && !system.arm.is_object())
      options.reject("arm", "must be an object");
    // An empty list says that nothing is known of the axis, and here an arm is.
    for (Axis& axis : system.axes)
      axis.has_base = axis.has_base && (system.arm.is_null() || !axis.base.empty());
  }
  options.finish();
  system.json = json;
  return system;
}

System read_system(const std::filesystem::path& path) {
  return parse_system(read_json(path, Exit::kData), path.string());
}

}  // namespace dcnn
