// Findings in plain words.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/judgement.h"

namespace dcnn {

/// "dry friction of 0.42 N along the tool": what was found, with its leading number.
std::string in_words(const Member& member, const std::vector<Estimate>& numbers);

/// A number with three digits that count.
std::string brief(double value);

}  // namespace dcnn
