// SPDX-License-Identifier: Apache-2.0
// Names that are the components of a frame by those that stand beside them.
#pragma once

#include <string>
#include <vector>

#include "dcnn/import/log.h"

namespace dcnn {

/// "r23" or "z" of T12 and T23 beside T00 (counted from 0) or T44 (from 1), of a matrix called by
/// one letter; empty where it is none, or an element of the last row.
std::string matrix_word(const LogStream& stream, const std::string& channel);

/// KUKA's frames are {X, Y, Z, A, B, C}, where A, B and C turn about z, y' and x'': "alpha" of A,
/// A_IST or RIst.A beside the other five of its kind.
std::string kuka_word(const LogStream& stream, const std::vector<std::string>& words);

/// How many elements the array has that a name is one of: 7 of tau[2]; 0 of a name without a number
/// behind it. At most 16.
int elements_beside(const LogStream& stream, const std::string& channel);

}  // namespace dcnn
