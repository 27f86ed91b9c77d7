// SPDX-License-Identifier: Apache-2.0
// A designed motion in words.
#pragma once

#include "dcnn/design/design.h"
#include "design/path.h"
#include "design/question.h"

namespace dcnn::design {

/// "speed_mps 98 %".
std::string limit_words(const Usage& usage);
/// What moves, how far and how fast, and what that decides.
std::string motion_words(const Played& played, const Question& question, const Design& design);

}  // namespace dcnn::design
