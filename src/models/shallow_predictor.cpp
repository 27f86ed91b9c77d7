// SPDX-License-Identifier: Apache-2.0
// Predictions of the shallow networks: feed-forward ones in single precision, as the other
// networks, cascades, which are no chain of layers, in double.
#include <utility>

#include "models/shallow_model.h"

namespace dcnn {
namespace {

/// Outputs in the targets' units.
struct OutputScale {
  Eigen::RowVectorXd middle, half_range;
};

class CascadePredictor final : public Predictor {
 public:
  CascadePredictor(ShallowInput::Streaming input, const ShallowNetwork& network,
                   const Eigen::VectorXd& weights, OutputScale scale)
      : input_(std::move(input)),
        network_(network),
        weights_(weights),
        scale_(std::move(scale)),
        signals_(network.signals()),
        outputs_(scale_.middle.size()),
        y_(scale_.middle.size()) {}

  void reset() noexcept override { input_.reset(); }

  const Eigen::VectorXd& push(const Eigen::VectorXd& x) noexcept override {
    input_.push(x, signals_);
    network_.forward(weights_, signals_, outputs_);
    y_ = (outputs_.cwiseProduct(scale_.half_range) + scale_.middle).transpose();
    return y_;
  }

 private:
  ShallowInput::Streaming input_;
  ShallowNetwork network_;
  Eigen::VectorXd weights_;
  OutputScale scale_;
  Eigen::RowVectorXd signals_, outputs_;
  Eigen::VectorXd y_;
};

class FeedForwardPredictor final : public Predictor {
 public:
  FeedForwardPredictor(ShallowInput::Streaming input, const Network& network, OutputScale scale)
      : input_(std::move(input)),
        plan_(network.plan()),
        scale_(std::move(scale)),
        signals_(network.input()[0]),
        cells_(network.input()),
        y_(scale_.middle.size()) {}

  void reset() noexcept override { input_.reset(); }

  const Eigen::VectorXd& push(const Eigen::VectorXd& x) noexcept override {
    input_.push(x, signals_);
    for (Index i = 0; i < signals_.size(); ++i) cells_.data()[i] = static_cast<Real>(signals_[i]);
    const Real* outputs = plan_.run(cells_.data());
    for (Index j = 0; j < y_.size(); ++j) {
      y_[j] = scale_.middle[j] + scale_.half_range[j] * static_cast<double>(outputs[j]);
    }
    return y_;
  }

 private:
  ShallowInput::Streaming input_;
  Plan plan_;
  OutputScale scale_;
  Eigen::RowVectorXd signals_;
  Tensor cells_;
  Eigen::VectorXd y_;
};

/// (n, outputs) of mapped inputs (n, inputs).
RowMatrix batch_outputs(const BatchPlan& batches, const RowMatrix& inputs, Index outputs) {
  using Reals = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Reals x = inputs.cast<Real>();
  Reals y(inputs.rows(), outputs);
  batches.run(x.data(), x.rows(), y.data());
  return y.cast<double>();
}

RowMatrix cascade_outputs(const ShallowNetwork& network, const Eigen::VectorXd& weights,
                          const RowMatrix& inputs) {
  RowMatrix result(inputs.rows(), network.shape().outputs);
  const Index pieces = piece_count(inputs.rows());
  for_each_piece(pieces, [&](Index k) {
    const Index first = piece_begin(inputs.rows(), pieces, k);
    const Index n = piece_begin(inputs.rows(), pieces, k + 1) - first;
    RowMatrix signals(n, network.signals());
    signals.leftCols(inputs.cols()) = inputs.middleRows(first, n);
    result.middleRows(first, n) = network.forward(weights, signals);
  });
  return result;
}

}  // namespace

void ShallowModel::set_weights(Eigen::VectorXd weights) {
  weights_ = std::move(weights);
  if (const auto chain = network()) batches_ = std::make_unique<BatchPlan>(*chain);
}

std::unique_ptr<Predictor> ShallowModel::predictor() const {
  ShallowInput::Streaming input(input_, map_);
  OutputScale scale{middle_, half_range_};
  if (const auto chain = network()) {
    return std::make_unique<FeedForwardPredictor>(std::move(input), *chain, std::move(scale));
  }
  return std::make_unique<CascadePredictor>(std::move(input), network_, weights_, std::move(scale));
}

Eigen::MatrixXd ShallowModel::predict(const Stream& stream) const {
  const RowMatrix inputs = input_.read(stream, map_, all_rows(stream.rows()));
  RowMatrix outputs = batches_ ? batch_outputs(*batches_, inputs, middle_.size())
                               : cascade_outputs(network_, weights_, inputs);
  outputs.array().rowwise() *= half_range_.array();
  outputs.rowwise() += middle_;
  return outputs;
}

std::optional<Network> ShallowModel::network() const {
  if (network_.shape().cascade) return std::nullopt;
  Json layers = Json::array();
  for (std::size_t l = 0; l < network_.layers().size(); ++l) {
    if (l > 0) layers.push_back({{"kind", "tanh"}});
    layers.push_back({{"kind", "linear"}, {"outputs", network_.layers()[l].units}});
  }
  Rng rng(0);  // every value is overwritten
  Network result(layers, {network_.shape().inputs}, rng);
  for (std::size_t l = 0; l < network_.layers().size(); ++l) {
    const RowMatrix weights = ShallowNetwork::weights_of(network_.layers()[l], weights_);
    const Tensor& matrix = result.state()[2 * l].tensor;
    const Tensor& bias = result.state()[2 * l + 1].tensor;
    for (Index o = 0; o < weights.cols(); ++o) {
      bias.data()[o] = static_cast<Real>(weights(0, o));
      for (Index i = 1; i < weights.rows(); ++i) {
        matrix.data()[o * (weights.rows() - 1) + i - 1] = static_cast<Real>(weights(i, o));
      }
    }
  }
  return result;
}

}  // namespace dcnn
