// SPDX-License-Identifier: Apache-2.0
// What a logged rate may be beside the derivative of its position.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/reading.h"

namespace dcnn::check {

/// What a logged rate may be, (n,columns) each, if it is not what it is called.
struct RateMeaning {
  Eigen::MatrixXd rate;  ///< SI
  double scale;          ///< logged = scale * rate
  std::string words;
  double price = 0.0;  ///< nats, of a number that was fitted
};

/// The first is the declared one. `turns`: an angle's rate; `radians`: the angle is in rad.
std::vector<RateMeaning> rate_meanings(const Eigen::MatrixXd& rate, bool turns, bool radians);
/// -ln of the likelihood of the logged rate, SI, as one meaning has it.
double rate_cost(const Eigen::MatrixXd& logged, const RateMeaning& meaning, double independent);

/// The same where the logged rate does not follow the position at all: a joint at rest, or
/// positions that are held or too coarse to be differentiated. No other meaning explains less than
/// that.
double unrelated_cost(const Eigen::MatrixXd& logged, const Eigen::MatrixXd& rate,
                      double independent);

/// The declared rate times another factor, by least squares, where that is none of the others' and
/// matters.
std::optional<RateMeaning> scaled_rate(const Eigen::MatrixXd& logged,
                                       const std::vector<RateMeaning>& known);

struct JointRate {
  std::string channel, position;
  bool turns = true;
  Eigen::MatrixXd logged;  ///< (n,1), smoothed, in units of the file
  double unit = 1.0;       ///< SI per unit of the file, as the reading has it
  std::vector<RateMeaning> meanings;
};
/// Of the joints whose positions change.
std::vector<JointRate> joint_rates(const Log& log, const Sampled& rows, const Reading& reading);

}  // namespace dcnn::check
