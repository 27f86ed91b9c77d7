// SPDX-License-Identifier: Apache-2.0
// The next experiment: the motion within a robot's limits that best tells apart what a report
// leaves open.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/csv.h"
#include "dcnn/design/limits.h"
#include "dcnn/diagnosis/diagnose.h"

namespace dcnn::design {

struct DesignRequest {
  Json report, model;  ///< report.json and model.json of dcnn-diagnose
  std::string where;   ///< names them in errors
  Limits limits;
  double seconds = 30.0;  ///< of the motion
  int evaluations = 300;  ///< motions that are judged: what the search costs
  std::uint64_t seed = 1;
};

/// Two structures on the designed motion.
struct Verdict {
  std::string one, other;  ///< what the one holds and the other does not
  double separation =
      0.0;  ///< deviations of the noise, with the other's numbers refitted to the one's forces
  double probability = 0.0;  ///< that dcnn-diagnose lists the other no more where the one is true
};

struct Design {
  Table motion;                     ///< t from 0; x … gamma, or joints q1 … and x … gamma
  std::vector<std::string> limits;  ///< each limit and its share that is used, in words
  double greatest_use = 0.0;        ///< of any limit; 1 at most
  std::string chosen;               ///< names of the report's own model
  std::vector<Verdict> verdicts;    ///< of the chosen structure and its likeliest rival first
  double unknown = 0.0;             ///< probability that no name describes what is left
  double information = 0.0;         ///< nats about a law linear in the states, for each of these
  /// That one structure is left, and the right one, if one of those weighed is true; none without a
  /// rival.
  std::optional<double> probability;
  std::string words;
};

/// `progress` is told what share of the search is done; it may be empty.
Design make_design(const DesignRequest& request, const std::function<void(double)>& progress);

/// `next_motion` of report.json; null where nothing is left to be decided.
Json next_motion(const Design& design, double seconds);
/// The same of a diagnosis of a tool with a simulator of its own, in every direction as far and as
/// fast as its first recording moved in one; null for other machines, poses at rest and where
/// nothing is left to be decided.
Json next_motion(const DiagnosisRequest& request, const Diagnosis& diagnosis);
std::string to_text(const Design& design);
Json to_json(const Design& design, double seconds);

}  // namespace dcnn::design
