// SPDX-License-Identifier: Apache-2.0
// The data doctor: what is wrong with a log, how sure that is, and what mends it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dcnn/check/log.h"
#include "dcnn/core/json.h"

namespace dcnn::check {

/// Something that is wrong with a log.
struct Fault {
  std::string id;
  double probability = 0.0;  ///< posterior, with the priors of docs/use/check.md
  std::string channel;       ///< a column, empty where it concerns all
  std::optional<std::pair<double, double>> interval_s;  ///< in the log's own t
  std::string words, remedy, flag;
  bool stops = false;  ///< a result from such a log would be about the fault
};

/// From this probability on a fault is certain, and tools that learn from the log stop.
inline constexpr double kCertain = 0.999;
/// From this probability on it is likely.
inline constexpr double kLikely = 0.5;

/// One way to read the log, and its posterior probability.
struct ReadingWeight {
  std::string words;
  double probability = 0.0;
};

/// Lines for a picture.
struct Curve {
  std::string label, quantity;  ///< "force [N]"
  Eigen::VectorXd t, values;
};

struct Report {
  std::string log;
  std::vector<Fault> faults;            ///< by falling probability
  std::vector<ReadingWeight> readings;  ///< by falling probability, the likeliest few
  std::map<std::string, bool> identifiable;
  std::vector<std::string> notes;      ///< why something could not be looked at
  std::vector<Curve> measured, rigid;  ///< per axis: as logged, and the best fit of `model`
  std::string model;                   ///< "rigid tool"

  /// The first fault that is certain and stops.
  const Fault* stopping(const std::vector<std::string>& accepted) const;
};

/// Every fault that is looked for, in the order of faults.def.
std::vector<std::string> fault_names();

Report check(const Log& log);

/// "centre of mass, x" for "com_x": a key of Report::identifiable.
std::string words_of_number(const std::string& key);

/// "nothing is wrong that can be told from the data", or the likeliest fault in words.
std::string verdict(const Report& report);

/// The form of docs/use/check.md.
Json to_json(const Report& report);
std::string to_text(const Report& report);

}  // namespace dcnn::check
