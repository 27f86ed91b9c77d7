// SPDX-License-Identifier: Apache-2.0
// Cases from files.
#pragma once

#include "dcnn/diagnosis/diagnose.h"
#include "diagnosis/case.h"

namespace dcnn {

/// The case of a wrist sensor: recordings to fit on, and those held out as logs of a second case of
/// the same simulator. Recordings are in the order of their clocks.
struct LoadedCase {
  Case fit, holdout;
};
LoadedCase load_wrist(const DiagnosisRequest& request);

/// Gives a recording a name that tells it from the others of the request, and takes off what that
/// says is no reading, with a note.
void name_and_cut(const DiagnosisRequest& request, const std::filesystem::path& path,
                  Recording& recording);

/// All of these recordings, with the rows left that bring something new and single outliers mended
/// in the columns `targets`: keep_new_rows(), leave_out_repeats(), mend_spikes().
std::vector<Recording*> with_usable_rows(std::vector<Recording>& fit,
                                         std::vector<Recording>& holdout, const System& system,
                                         const std::vector<std::string>& targets);

/// Error(kData) unless all recordings have one rate, or all are lists of poses: spectra, noise and
/// events are judged on one clock.
void check_rates(const std::vector<Recording>& recordings);

/// Of the columns of these names, which vary over the fitted recordings and stand in all of them;
/// with their ranges in the fitted ones.
std::vector<Case::Driver> drivers_of(const std::vector<std::string>& names,
                                     const std::vector<Recording>& fit,
                                     const std::vector<Recording>& holdout);

/// Whether the recordings share one clock, and when it ends. Error(kData)
/// where they are told to share one and overlap.
void set_clock(const DiagnosisRequest& request, const std::vector<Recording>& recordings,
               Case& study);

}  // namespace dcnn
