// SPDX-License-Identifier: Apache-2.0
// Rivals of the diagnosis: sparse regression on the catalogue's laws as a linear library.
#pragma once

#include <filesystem>
#include <vector>

#include "dcnn/core/json.h"

namespace dcnn::rivals {

struct Request {
  std::filesystem::path simulator;
  std::vector<std::filesystem::path> fit, holdout;
};

/// For every method a report with `verdict`, `findings` and `fit` as dcnn-diagnose writes them
/// (report.json), and `seconds` it took, the library's included. Library: each law at the
/// seeds of its shapes on each axis, differentiated by its amplitudes at zero; means over 20 ms of
/// measured less simulated force; the derivatives' window is the one with which laws without shapes
/// leave least. Laws whose instants or frequencies have to be searched for are not in a linear
/// library. {"stlsq": {…}, …}. Error(kData) for files that cannot be used.
Json run(const Request& request);

}  // namespace dcnn::rivals
