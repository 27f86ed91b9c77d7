// SPDX-License-Identifier: Apache-2.0
// What a user says about a log of somebody else.
#pragma once

#include "dcnn/import/recipe.h"
#include "support/tool.h"

namespace dcnn {

class ImportFlags {
 public:
  /// What a recipe says is not said again: all but --truncated exclude `recipe`.
  ImportFlags(Tool& tool, const Option& recipe);
  ReadLogOptions read() const;
  ImportWishes wishes() const;
  /// Streams of --clock-offset STREAM=auto.
  std::vector<std::string> estimated_offsets() const;

 private:
  std::vector<Option> text(Tool& tool);
  std::vector<Option> channels(Tool& tool);
  std::vector<Option> clocks(Tool& tool);
  std::vector<Option> frames(Tool& tool);

  std::string separator_, decimal_;
  std::vector<std::string> columns_, use_, map_, units_, gains_, offsets_, wraps_, also_;
  std::vector<std::string> clock_offsets_;
  std::vector<std::string> clock_;
  std::string clock_unit_, stamps_ = "header";
  double rate_hz_ = 0.0;
  std::string quaternion_order_, euler_order_, wrench_frame_ = "auto";
  bool inverse_ = false, truncated_ = false, zeroed_ = false;
  std::vector<double> turn_, origin_, payload_;
  std::string urdf_, link_, base_link_;
};

}  // namespace dcnn
