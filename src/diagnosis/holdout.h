// SPDX-License-Identifier: Apache-2.0
// The error on recordings, or blocks of time, that nothing was decided on.
#pragma once

#include "dcnn/diagnosis/diagnose.h"
#include "diagnosis/evidence/support.h"
#include "diagnosis/search.h"

namespace dcnn {

/// Every fifth piece of 5 s (of short recordings of less), with guards of a tenth on both sides.
std::vector<Span> held_out_blocks(const Case& study, bool with_guards);

class HoldOut {
 public:
  /// Recordings of their own, or (`recordings` without logs) the blocks of the fitted ones.
  HoldOut(const Case& fitted, const Case& recordings);

  /// No row was held out: the recordings are too short, or lists of poses.
  bool empty() const;
  /// RMSE by channel of the case's simulator with these members, with these coefficients of its
  /// linear base where it has one.
  std::vector<double> rmse(const std::vector<Member>& members, const Eigen::VectorXd& base) const;
  /// Their mean over the channels.
  double mean_rmse(const std::vector<Member>& members, const Eigen::VectorXd& base) const;
  /// What a prediction says of how each channel varies, about the means of the recordings.
  struct Worth {
    std::vector<double> measured_rms;
    std::vector<double> explained;  ///< 1 - variance of the error / variance of the measured
  };
  Worth worth(const std::vector<Member>& members, const Eigen::VectorXd& base) const;
  /// A channel whose error exceeds 1.2 times its noise (`floors`, of held-out blocks that of the
  /// fitted recordings; with a tool's pose that is differentiated also what the model leaves where
  /// it was fitted: the error of the filtered pose stands in both; or noise_of_all() of that, if
  /// the band above the motion bears it out, times the ratio of held-out to fitted noise) by more
  /// than chance makes of so many rows (97.5 %), of which a whitener's block counts as one: the
  /// farthest.
  struct Excess {
    std::size_t channel;
    double ratio;  ///< error over noise
    bool of_fit;   ///< which is what the model leaves of the fitted recordings
  };
  std::optional<Excess> excess(const Search& search, const std::vector<Floor>& floors) const;
  /// Whether something was held out and no channel's error exceeds so many times its noise.
  bool is_noise(const Search& search, const std::vector<Floor>& floors, double most) const;
  /// The noise of the held-out recordings, by what the model leaves of them above the motion's
  /// band; of held-out blocks that of the fitted rows, but never more than the error; of poses at
  /// rest that of the fitted ones.
  std::vector<Floor> floors(const Search& search) const;
  Signals prediction(const std::vector<Member>& members, const Eigen::VectorXd& base) const;
  /// ln of the factor by which the held-out data change the odds of one prediction against another
  /// (diagnosis/evidence/support.h; blocks of 1 s, of poses at rest each). Where noise of the
  /// motion makes the one `noisier`, by these variances of the channels, its errors are so much
  /// larger though its law be right.
  double log_support(const Signals& with, const Signals& without, const std::vector<Floor>& floors,
                     const std::vector<double>& noisier = {}) const;
  /// The same of each channel alone, in whose fitted rows what they predict apart gained so much of
  /// chi-square: what helps most channels may be wrong in one.
  std::vector<double> support_by_channel(const Signals& with, const Signals& without,
                                         const std::vector<Floor>& floors,
                                         const std::vector<double>& gained) const;
  /// Of what a prediction without a name leaves beyond noise, the share that the name explains
  /// (diagnosis/evidence/support.h): of means over `block` rows, of the variances `noise`.
  double share_explained(const Signals& with, const Signals& without, const Eigen::VectorXd& noise,
                         Index block) const;
  /// ln of the Bayes factor of the detected impacts (diagnosis/impacts.h); 0 for held-out blocks.
  double support_of_impacts(const Search& search) const;
  std::vector<HeldOut> records(const JointFit& before, const JointFit& after) const;
  /// The same recordings without the low-pass.
  HoldOut unfiltered() const;

 private:
  HoldOut() = default;
  std::vector<evidence::BlockChange> changes(const std::vector<Index>& channels,
                                             const Signals& with, const Signals& without,
                                             const std::vector<Floor>& floors,
                                             const std::vector<double>& noisier) const;
  /// What errors of a known base explain of what each of two predictions leaves of the rows held
  /// out, (T, 1) each; none of another case.
  std::pair<Signals, Signals> of_base_errors(const Signals& a, const Signals& b) const;
  /// RMS of what the model leaves of the rows that it was fitted to.
  double left_where_fitted(const Search& search, Eigen::Index channel) const;
  /// Of recordings of their own.
  std::vector<Floor> own_floors(const Search& search) const;
  /// Of a recording that was zeroed: from the rows that are not held out, or from these where all
  /// are.
  void add_own_offset(std::size_t recording, Eigen::MatrixXd& predicted) const;

  Case study_;
  std::vector<std::vector<char>> held_;  // per recording and row
  bool blocks_ = false;                  // of the fitted recordings
};

}  // namespace dcnn
