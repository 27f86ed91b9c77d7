// SPDX-License-Identifier: Apache-2.0
// Recordings to rows to learn from and rows to validate on.
#pragma once

#include "dcnn/experiment/train.h"

namespace dcnn {

/// How many rows a recording of which the last `share` is for validation gives to training: those
/// that end 1 s before.
Index training_rows(const Recording& recording, double share);

/// The configuration, or one of its candidates, trains with noise on the pose.
bool wants_pose_noise(const Json& configuration);

/// Features and targets of recordings, split by time. Rows near the Euler singularity are left out.
class Splitter {
 public:
  /// Draws of noise on the pose that an epoch chooses from.
  static constexpr std::uint64_t kPoseDraws = 4;

  /// `pose_noise`: training rows come with draws of noise on the pose, which the identifier's seed
  /// names; a feature set that has none is Error(kUsage).
  Splitter(const Identifier& identifier, const TrainingObserver& observer, bool pose_noise);

  /// The last `share` of the recording's rows go to `validation`, those before them by 1 s or more
  /// to `training`.
  void add(const Recording& recording, double share, Samples& training, Samples& validation) const;
  /// All rows, without draws of noise.
  void add_whole(const Recording& recording, Samples& samples) const;

 private:
  struct Rows;
  Rows read(const Recording& recording) const;
  /// (T, F) each; `before` rows of other recordings tell the draws of this one from theirs.
  std::vector<Eigen::MatrixXd> draws(const Recording& recording, Index before) const;

  const Identifier& identifier_;
  const TrainingObserver& observer_;
  bool pose_noise_;
};

}  // namespace dcnn
