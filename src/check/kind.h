// SPDX-License-Identifier: Apache-2.0
// What every fault of faults.def supplies.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "check/reading.h"
#include "dcnn/check/check.h"

namespace dcnn::check {

/// What detectors look at: the log, and how it is best read.
struct Evidence {
  const Log& log;
  const Adopted& adopted;
};

/// What a rigid tool is fitted to: the log under one reading.
struct Fitting {
  const Log& log;
  const Sampled& rows;
  const Kinematics& motion;
  const Reading& base;
};

/// A fault is found by an alternative reading of the log that explains it better (`readings`), or
/// by a statistic of its own (`find`).
struct FaultKind {
  const char* id;
  bool stops;  ///< when certain, the tools that learn from the log stop
  const char* remedy;
  const char* flag;  ///< option that mends it; "" for none
  std::vector<Fault> (*find)(const Evidence&) = nullptr;
  void (*readings)(const Log&, const Reading& base, std::vector<Reading>& out) = nullptr;
  bool of_force = false;  ///< a reading of the forces or of their frame
  /// Readings whose numbers are estimated, by fits of the reading that they alter.
  void (*estimates)(const Fitting& fitting, std::vector<Reading>& out) = nullptr;
  bool combines = false;  ///< its readings are weighed together with those of its like, too
};

#define FAULT(id) extern const FaultKind id##_fault;
#include "check/faults.def"
#undef FAULT

const std::vector<const FaultKind*>& fault_kinds();

/// A fault with its kind's remedy; `probability` is that of the statistic.
Fault fault_of(const FaultKind& kind, double probability, const std::string& channel,
               const std::string& words);
/// A fault that is counted in the log and inferred from nothing: of probability 1.
Fault fact_of(const FaultKind& kind, const std::string& channel, const std::string& words);

}  // namespace dcnn::check
