// SPDX-License-Identifier: Apache-2.0
// The files a diagnosis writes (docs/use/diagnose.md).
#pragma once

#include <filesystem>

#include "dcnn/diagnosis/diagnose.h"

namespace dcnn {

/// report.json, report.html, model.json, and predictions: holdout_<k>_pred.csv per held-out
/// recording, or, where blocks of the fitted ones were held out, with a column `held_out`.
void write_diagnosis(const std::filesystem::path& folder, const Diagnosis& diagnosis);

/// The headline, then a few lines: what the terminal shows.
std::string to_text(const Diagnosis& diagnosis);

/// The page: what was found first, then the pictures that show it.
std::string to_html(const Diagnosis& diagnosis);

}  // namespace dcnn
