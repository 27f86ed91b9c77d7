#include <utility>

#include "models/shallow_model.h"

namespace dcnn {
namespace {

class ShallowPredictor final : public Predictor {
 public:
  ShallowPredictor(ShallowInput::Streaming input, const ShallowNetwork& network,
                   const Eigen::VectorXd& weights, const Eigen::RowVectorXd& middle,
                   const Eigen::RowVectorXd& half_range)
      : input_(std::move(input)),
        network_(network),
        weights_(weights),
        middle_(middle),
        half_range_(half_range),
        signals_(network.signals()),
        outputs_(middle.size()),
        y_(middle.size()) {}

  void reset() noexcept override { input_.reset(); }

  const Eigen::VectorXd& push(const Eigen::VectorXd& x) noexcept override {
    input_.push(x, signals_);
    network_.forward(weights_, signals_, outputs_);
    y_ = (outputs_.cwiseProduct(half_range_) + middle_).transpose();
    return y_;
  }

 private:
  ShallowInput::Streaming input_;
  ShallowNetwork network_;
  Eigen::VectorXd weights_;
  Eigen::RowVectorXd middle_, half_range_, signals_, outputs_;
  Eigen::VectorXd y_;
};

}  // namespace

std::unique_ptr<Predictor> ShallowModel::predictor() const {
  return std::make_unique<ShallowPredictor>(ShallowInput::Streaming(input_, map_), network_,
                                            weights_, middle_, half_range_);
}

}  // namespace dcnn
