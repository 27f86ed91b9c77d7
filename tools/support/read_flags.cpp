// SPDX-License-Identifier: Apache-2.0
// How recordings are read: what every tool that takes them offers.
#include <numbers>

#include "dcnn/data/table_reader.h"
#include "dcnn/import/assemble.h"
#include "support/recipe_option.h"

namespace dcnn {

namespace {

constexpr const char* kReading = "Reading recordings";

void add(std::vector<std::string>& words, const char* option, const std::string& value) {
  words.insert(words.end(), {option, value});
}

}  // namespace

UnitFlags::UnitFlags(Tool& tool)
    : options_{tool.option("--position-unit", position_unit_, "unit of positions in the recordings")
                   .one_of({"m", "mm"})
                   .with_default()
                   .group(kReading),
               tool.option("--angle-unit", angle_unit_, "unit of angles in the recordings")
                   .one_of({"rad", "deg"})
                   .with_default()
                   .group(kReading),
               tool.option("--force-sign", force_sign_, "-1 where the log holds the reaction")
                   .one_of({1.0, -1.0})
                   .with_default()
                   .group(kReading)} {}

void UnitFlags::exclude(const Option& other) {
  for (const Option& option : options_) option.excludes(other);
}

ReadOptions UnitFlags::options() const {
  ReadOptions options;
  if (position_unit_ == "mm") options.position_unit = 1e-3;
  if (angle_unit_ == "deg") options.angle_unit = std::numbers::pi / 180.0;
  options.force_sign = force_sign_;
  return options;
}

std::vector<std::string> UnitFlags::words() const {
  std::vector<std::string> words;
  if (position_unit_ != "m") add(words, "--position-unit", position_unit_);
  if (angle_unit_ != "rad") add(words, "--angle-unit", angle_unit_);
  if (force_sign_ < 0.0) add(words, "--force-sign", "-1");
  return words;
}

ReadFlags::ReadFlags(Tool& tool) : units_(tool) {
  tool.option("--payload", payload_,
              "KG [X Y Z]: mass and centre [m] of a body whose weight the robot's controller has "
              "subtracted from the force; it is added back")
      .group(kReading);
  resample_ =
      tool.option("--resample", resample_hz_,
                  "put irregular clocks on a regular one [Hz; default: the recording's rate]")
          .value_optional()
          .between(0, 1000000)
          .group(kReading);
  add_recipe_option(tool, recipe_).group(kReading);
}

Option add_recipe_option(Tool& tool, std::optional<std::filesystem::path>& recipe) {
  return tool
      .option("--recipe", recipe,
              "import.json of dcnn-import: recordings are logs of any format that it reads")
      .holds({FileKind::kRecipe});
}

void read_by_recipe(const std::filesystem::path& file) {
  set_table_reader([recipe = read_recipe(file)](const std::filesystem::path& log) {
    Imported imported = import_recording(log, recipe, {});
    imported.notes.insert(imported.notes.begin(), "imported by a recipe");
    return SourceTable{std::move(imported.table), std::move(imported.notes), recipe.wrench.zeroed};
  });
}

Payload payload_of(const std::vector<double>& numbers) {
  if (numbers.empty()) return {};
  require((numbers.size() == 1 || numbers.size() == 4) && numbers[0] > 0.0, Exit::kUsage,
          "--payload: give the mass in kg, above 0, and where the centre of mass matters (torques) "
          "its x y z in m");
  Payload payload;
  payload.mass = numbers[0];
  if (numbers.size() == 4) payload.com = {numbers[1], numbers[2], numbers[3]};
  return payload;
}

ReadOptions ReadFlags::options() const {
  if (recipe_) read_by_recipe(*recipe_);
  ReadOptions options = units_.options();
  options.payload = payload_of(payload_);
  options.resample = resample_->given();
  options.resample_hz = resample_hz_;
  return options;
}

std::vector<std::string> ReadFlags::words() const {
  std::vector<std::string> words = units_.words();
  for (std::size_t k = 0; k < payload_.size(); ++k) {
    if (k == 0) words.emplace_back("--payload");
    words.push_back(Json(payload_[k]).dump());
  }
  if (resample_->given()) add(words, "--resample", Json(resample_hz_).dump());
  return words;
}

}  // namespace dcnn
