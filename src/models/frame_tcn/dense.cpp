// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/dense.h"

#include <array>
#include <cmath>

namespace dcnn::frame_tcn {
namespace {

/// Inputs and outputs of each layer, and where its weights begin; offsets follow them.
struct Layer {
  Index inputs, outputs, begin;
  Index end() const { return begin + (inputs + 1) * outputs; }
};
constexpr Layer kOne{Dense::kInputs, Dense::kFirst, kChannels* Dense::kInputs};
constexpr Layer kTwo{Dense::kFirst, Dense::kSecond, kOne.begin + (kOne.inputs + 1) * kOne.outputs};
constexpr Layer kThree{Dense::kSecond, kChannels, kTwo.begin + (kTwo.inputs + 1) * kTwo.outputs};

Eigen::Map<const Eigen::MatrixXd> weights(const double* p, const Layer& l) {
  return {p + l.begin, l.outputs, l.inputs};
}
Eigen::Map<const Eigen::VectorXd> offsets(const double* p, const Layer& l) {
  return {p + l.begin + l.inputs * l.outputs, l.outputs};
}

void put(const double* p, const Layer& l, const Eigen::MatrixXd& x, Eigen::MatrixXd& y) {
  y.resize(l.outputs, x.cols());
  y.noalias() = weights(p, l) * x;
  y.colwise() += offsets(p, l);
}

void put_units(const double* p, const Layer& l, const Eigen::MatrixXd& x, Eigen::MatrixXd& y) {
  put(p, l, x, y);
  y = y.array().tanh();
}

/// Adds the gradient of a layer's parameters for dLoss/doutput.
void pull(const Layer& l, const Eigen::MatrixXd& x, const Eigen::MatrixXd& dy, double* gradient) {
  Eigen::Map<Eigen::MatrixXd>(gradient + l.begin, l.outputs, l.inputs) += dy * x.transpose();
  Eigen::Map<Eigen::VectorXd>(gradient + l.begin + l.inputs * l.outputs, l.outputs) +=
      dy.rowwise().sum();
}

}  // namespace

Index Dense::size() { return kThree.end(); }

void Dense::start(Eigen::Ref<Eigen::VectorXd> p, Rng& rng) {
  p.setZero();
  for (const Layer& l : {kOne, kTwo, kThree}) {
    // The last layer begins small: at first the linear part speaks alone.
    const double deviation = (l.outputs == kChannels ? 0.1 : 1.0) / std::sqrt(double(l.inputs));
    for (double& w : p.segment(l.begin, l.inputs * l.outputs)) w = deviation * rng.normal();
  }
}

void Dense::forward(const double* p, const Eigen::MatrixXd& means, const Eigen::MatrixXd& levels,
                    Signals& s, Eigen::MatrixXd& clean) {
  s.inputs.resize(kInputs, means.cols());
  s.inputs.topRows(kChannels * kBlocks) = means;
  s.inputs.bottomRows(kChannels) = levels;
  put_units(p, kOne, s.inputs, s.first);
  put_units(p, kTwo, s.first, s.second);
  put(p, kThree, s.second, clean);
  clean.noalias() += Eigen::Map<const Eigen::MatrixXd>(p, kChannels, kInputs) * s.inputs;
}

void Dense::backward(const double* p, const Signals& s, const Eigen::MatrixXd& d_clean,
                     double* gradient) {
  linear(gradient) += d_clean * s.inputs.transpose();
  pull(kThree, s.second, d_clean, gradient);
  const Eigen::MatrixXd d_second =
      (weights(p, kThree).transpose() * d_clean).array() * (1.0 - s.second.array().square());
  pull(kTwo, s.first, d_second, gradient);
  const Eigen::MatrixXd d_first =
      (weights(p, kTwo).transpose() * d_second).array() * (1.0 - s.first.array().square());
  pull(kOne, s.inputs, d_first, gradient);
}

}  // namespace dcnn::frame_tcn
