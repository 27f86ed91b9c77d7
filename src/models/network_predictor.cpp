// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include "dcnn/models/network_model.h"
#include "models/linear_skip.h"

namespace dcnn {
namespace {

class NetworkPredictor final : public Predictor {
 public:
  NetworkPredictor(std::unique_ptr<StreamingInput> input, std::optional<LinearSkip> skip,
                   std::optional<Plan> plan, TargetScale scale)
      : input_(std::move(input)),
        skip_(std::move(skip)),
        plan_(std::move(plan)),
        scale_(std::move(scale)),
        slides_(input_->slides()),
        y_(Eigen::VectorXd::Zero(scale_.mean.size())) {}

  void reset() noexcept override {
    input_->reset();
    begins_ = true;
  }

  const Eigen::VectorXd& push(const Eigen::VectorXd& x) noexcept override {
    const Real* cells = input_->push(x);
    if (skip_) {
      skip_->of(cells, y_);
    } else {
      y_.setZero();
    }
    if (!plan_) return y_;
    const Real* network = slides_ ? plan_->slide(cells, begins_) : plan_->run(cells);
    begins_ = false;
    for (Index j = 0; j < y_.size(); ++j) {
      y_[j] += scale_.mean[j] + scale_.deviation[j] * static_cast<double>(network[j]);
    }
    return y_;
  }

 private:
  std::unique_ptr<StreamingInput> input_;
  std::optional<LinearSkip> skip_;
  std::optional<Plan> plan_;
  TargetScale scale_;
  bool slides_, begins_ = true;
  Eigen::VectorXd y_;
};

}  // namespace

std::unique_ptr<Predictor> NetworkModel::predictor() const {
  std::optional<LinearSkip> skip;
  if (skip_) skip = *skip_;
  std::optional<Plan> plan;
  if (network_) plan = network_->plan(precision_);
  return std::make_unique<NetworkPredictor>(input_->streaming(map_), std::move(skip),
                                            std::move(plan), scale_);
}

}  // namespace dcnn
