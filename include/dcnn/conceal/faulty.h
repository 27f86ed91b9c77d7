// SPDX-License-Identifier: Apache-2.0
// Logs with one fault each, as people's loggers make them: what dcnn-check is measured on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/csv.h"

namespace dcnn::conceal {

struct FaultyLog {
  Table table;
  Json simulator;     ///< sim.json of the tool; null for joints
  Json system;        ///< system.json of an arm, with its links; null for others
  std::string fault;  ///< id of the fault that a check should name, empty for a clean log
};

/// Names of what make_faulty() makes, such as clock_ms, sign_fx, swap_xy; those of clean logs begin
/// with "clean".
std::vector<std::string> faulty_kinds();

/// A recording of 12 to 18 s at 250 Hz by this module's own world, with that fault; Error(kUsage)
/// for an unknown name. The same arguments give the same bytes.
FaultyLog make_faulty(const std::string& kind, std::uint64_t seed);

/// Puts the fault into a log that somebody recorded.
Table with_fault(const std::string& kind, Table log, std::uint64_t seed);

}  // namespace dcnn::conceal
