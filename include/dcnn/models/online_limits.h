// SPDX-License-Identifier: Apache-2.0
// What training knows about its own limits: which motion it saw, and how large its error is where
// nothing touches the tool.
#pragma once

#include <Eigen/Dense>

#include "dcnn/models/model.h"

namespace dcnn {

/// How often a monitor may cry wolf on motion like that of training.
constexpr double kFalseAlarmsPerHour = 1.0;

/// The level that the maximum over one second exceeds `per_hour` times an hour: the conformal order
/// statistic where an hour and more of scores is given, else an exponential tail through the larger
/// half of the maxima, two standard errors up (peaks over threshold; Coles 2001, chapter 4).
/// `scores` (N) in the order of time, `per_second` of them a second.
double alarm_level(const Eigen::VectorXd& scores, double per_second, double per_hour);

/// The motion of training: every feature by itself, and all of them by their Mahalanobis distance.
class Envelope {
 public:
  Envelope() = default;
  /// From training features (N, F). Thresholds come from blocks of time that the statistics they
  /// are scored with have not seen; each of the two monitors takes half of the false alarms.
  Envelope(const Eigen::MatrixXd& x, double dt);

  Index features() const { return mean_.size(); }
  /// Above 1 is unlike training. Allocates nothing; NaN for a feature that is not finite.
  double score(const Eigen::VectorXd& x) const noexcept;

  Json to_json() const;
  static Envelope parse(const Json& json, const std::string& where);

 private:
  struct Parts {
    double distance, channel;
  };
  void learn(const Eigen::MatrixXd& x);
  Parts parts(const double* x, Index stride) const noexcept;

  Eigen::VectorXd mean_, scale_;
  Eigen::MatrixXd whitener_;  // lower triangle: L^-1 of the correlation L·L^T
  double distance_limit_ = 1.0, channel_limit_ = 1.0;
};

/// Samples over which the force is averaged before it may count as a contact: 50 ms.
Index contact_window(double dt);

/// The mean force over contact_window() that nothing but the model's error exceeds
/// kFalseAlarmsPerHour, N. `residual` (N, 3): measured less predicted where nothing touches.
double contact_level(const Eigen::MatrixXd& residual, const std::vector<Segment>& segments,
                     double dt);

/// What dcnn-run needs to know; part of a model file that was trained with --online.
struct OnlineLimits {
  Envelope envelope;
  Eigen::VectorXd residual_rmse;  ///< (targets) on rows held out
  double contact_n = 0.0;
};

/// From training rows, and validation rows for the residual where there are any.
OnlineLimits learn_limits(const Model& model, const Targets& targets, const Samples& training,
                          const Samples& validation, double dt);
Json to_json(const OnlineLimits& limits);
OnlineLimits parse_limits(const Json& json, const std::string& where);

}  // namespace dcnn
