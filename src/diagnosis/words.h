// Findings in plain words.
#pragma once

#include <string>
#include <vector>

#include "dcnn/core/number.h"
#include "diagnosis/judgement.h"

namespace dcnn {

/// "dry friction of 0.42 N along the tool": what was found, with its leading number.
std::string in_words(const Member& member, const std::vector<Estimate>& numbers);

}  // namespace dcnn
