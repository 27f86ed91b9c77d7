// SPDX-License-Identifier: Apache-2.0
// frame-tcn for one sample after another.
#pragma once

#include "dcnn/models/predictor.h"
#include "models/frame_tcn/dyadic_sums.h"
#include "models/frame_tcn/front.h"
#include "models/frame_tcn/net.h"

namespace dcnn::frame_tcn {

class FrameTcnPredictor final : public Predictor {
 public:
  /// `spread` (triples) is what a unit of each triple's output is worth.
  FrameTcnPredictor(Front front, Net net, const Eigen::VectorXd& spread);
  void reset() noexcept override;
  const Eigen::VectorXd& push(const Eigen::VectorXd& x) noexcept override;

 private:
  void put_roughness() noexcept;
  void put_experts() noexcept;

  Front front_;
  Net net_;
  Eigen::VectorXd spread_;
  DyadicSums rows_, bends_;  // of the channels, of the squares of their second differences
  Eigen::VectorXd row_, before_, second_before_, bend_;
  Eigen::MatrixXd roughness_;
  std::array<Eigen::VectorXd, kGroups> past_, estimates_;
  Pass pass_;
  Eigen::VectorXd y_;
  Index count_ = 0;  // rows of this segment
};

}  // namespace dcnn::frame_tcn
