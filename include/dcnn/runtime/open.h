// SPDX-License-Identifier: Apache-2.0
// From files to a compensator: what dcnn-run and the C interface (dcnn.h) open.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "dcnn/runtime/compensator.h"

namespace dcnn {

struct OnlineFiles {
  std::filesystem::path model;        ///< trained with --online, or a simulator (.json)
  std::filesystem::path fallback;     ///< simulator beside a trained model; may be empty
  std::filesystem::path calibration;  ///< of dcnn-calibrate; may be empty
  Precision precision = Precision::kSingle;
};

/// The compensator of these files. R_ES is that of the calibration, else of the simulator, else of
/// the model's features. `note` is told what is left out. Errors name the file.
OnlineCompensator open_compensator(const OnlineFiles& files, CompensatorOptions options,
                                   const std::function<void(const std::string&)>& note);

}  // namespace dcnn
