// SPDX-License-Identifier: Apache-2.0
// Adam (Kingma and Ba 2015) on a flat vector, with an average of the weights.
#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "dcnn/core/parallel.h"

namespace dcnn::frame_tcn {

struct Adam {
  Eigen::VectorXd first, second, average;
  Index steps = 0;

  explicit Adam(const Eigen::VectorXd& start)
      : first(Eigen::VectorXd::Zero(start.size())), second(first), average(start) {}

  /// One step; gradients longer than `clip` are shortened to it, `decay` is that of the average.
  void step(Eigen::VectorXd& p, Eigen::VectorXd g, double rate, double clip, double decay) {
    const double length = g.norm();
    if (length > clip) g *= clip / length;
    ++steps;
    first = 0.9 * first + 0.1 * g;
    second = 0.999 * second + 0.001 * g.cwiseAbs2();
    const auto t = static_cast<double>(steps);
    const double size = rate * std::sqrt(1.0 - std::pow(0.999, t)) / (1.0 - std::pow(0.9, t));
    p.array() -= size * first.array() / (second.array().sqrt() + 1e-9);
    // Short of 1/(1 - decay) steps the average would still hold the start.
    const double held = std::min(decay, (1.0 + t) / (10.0 + t));
    average = held * average + (1.0 - held) * p;
  }
};

}  // namespace dcnn::frame_tcn
