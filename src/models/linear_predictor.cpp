// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include "dcnn/data/line_filter.h"
#include "models/linear_model.h"

namespace dcnn {
namespace {

class LinearPredictor final : public Predictor {
 public:
  LinearPredictor(std::shared_ptr<const Regressors> regressors, const Eigen::MatrixXd& weights,
                  Index features, Index filter)
      : regressors_(std::move(regressors)),
        weights_(weights),
        x_(features),
        passed_(features),
        terms_(weights.rows()),
        y_(weights.cols()) {
    if (filter > 1) filter_.emplace(filter, features);
  }

  void reset() noexcept override { fresh_ = true; }

  const Eigen::VectorXd& push(const Eigen::VectorXd& x) noexcept override {
    x_ = x.transpose();
    if (filter_) {
      if (fresh_) filter_->restart(x_);
      fresh_ = false;
      filter_->push(x_, passed_);
    }
    regressors_->write(filter_ ? passed_ : x_, terms_);
    y_ = weights_.transpose().lazyProduct(terms_.transpose());
    return y_;
  }

 private:
  std::shared_ptr<const Regressors> regressors_;
  Eigen::MatrixXd weights_;  // (terms, targets)
  std::optional<LineFilter> filter_;
  Eigen::RowVectorXd x_, passed_, terms_;
  Eigen::VectorXd y_;
  bool fresh_ = true;
};

}  // namespace

std::unique_ptr<Predictor> LinearModel::predictor() const {
  return std::make_unique<LinearPredictor>(regressors_, weights_,
                                           static_cast<Index>(layout_.names.size()), filter_);
}

}  // namespace dcnn
