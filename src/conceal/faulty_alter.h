// SPDX-License-Identifier: Apache-2.0
// What a fault does to a clean table.
#pragma once

#include "conceal/faulty.h"

namespace dcnn::conceal {

using Alter = void (*)(Table&, Rng&);

/// One kind of faulty log.
struct FaultyKind {
  const char* name;
  const char* fault;  ///< the id that dcnn-check has for it
  CleanLog clean;
  Alter alter;
};

const std::vector<FaultyKind>& faults_of_meaning();  ///< units, signs, axes, frames, orders
const std::vector<FaultyKind>& faults_of_rows();     ///< clocks, channels, rows, contacts
const std::vector<FaultyKind>& faults_of_arms();     ///< joints against the arm's description

}  // namespace dcnn::conceal
