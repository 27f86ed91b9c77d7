// SPDX-License-Identifier: Apache-2.0
#include "models/shallow_network.h"

#include <gtest/gtest.h>

#include "models/shallow_residuals.h"

namespace dcnn {
namespace {

const std::vector<ShallowNetwork::Shape> kShapes{
    {4, {5}, 3, false},       {4, {5}, 3, true},       {3, {4, 3}, 2, false}, {3, {4, 3}, 2, true},
    {2, {3, 1, 2}, 3, false}, {2, {3, 1, 2}, 3, true}, {1, {1}, 1, false}};

RowMatrix drawn_rows(Index rows, Index columns, std::uint64_t seed) {
  Rng rng(seed);
  RowMatrix m(rows, columns);
  for (double& value : m.reshaped()) value = rng.uniform(-1.0, 1.0);
  return m;
}

RowMatrix outputs(const ShallowNetwork& network, const RowMatrix& inputs,
                  const Eigen::VectorXd& weights) {
  RowMatrix signals = RowMatrix::Constant(inputs.rows(), network.signals(), 1e9);
  signals.leftCols(inputs.cols()) = inputs;
  return network.forward(weights, signals);
}

TEST(ShallowNetwork, HasTheParameterCountsOfThePaper) {
  EXPECT_EQ(ShallowNetwork({15, {20}, 3, false}).parameter_count(), 383);
  EXPECT_EQ(ShallowNetwork({15, {9, 6}, 3, false}).parameter_count(), 225);
  EXPECT_EQ(ShallowNetwork({15, {20}, 3, true}).parameter_count(), 428);
  EXPECT_EQ(ShallowNetwork({15, {9, 6}, 3, true}).parameter_count(), 387);
}

/// The cascade written out: every layer sees a constant, the inputs and all layers before it.
TEST(ShallowNetwork, ForwardIsTheTextbookFormula) {
  const ShallowNetwork network({3, {4, 2}, 2, true});
  Rng rng(5);
  const Eigen::VectorXd w = network.initial_weights(rng);
  const RowMatrix x = drawn_rows(6, 3, 1), y = outputs(network, x, w);
  for (Index row = 0; row < x.rows(); ++row) {
    Eigen::VectorXd seen(4);
    seen << 1.0, x.row(row).transpose();
    Index offset = 0;
    for (const Index units : {4, 2, 2}) {
      const Eigen::Map<const RowMatrix> layer(w.data() + offset, seen.size(), units);
      const Eigen::VectorXd sums = layer.transpose() * seen;
      offset += layer.size();
      if (offset == w.size()) {
        EXPECT_NEAR((y.row(row).transpose() - sums).norm(), 0.0, 1e-12);
      } else {
        seen.conservativeResize(seen.size() + units);
        seen.tail(units) = sums.array().tanh();
      }
    }
  }
}

TEST(ShallowNetwork, NguyenWidrowSpreadsTheUnitsEvenly) {
  const ShallowNetwork network({15, {20, 1}, 3, true});
  Rng rng(7);
  const Eigen::VectorXd w = network.initial_weights(rng);
  const auto& layer = network.layers()[0];
  const auto first = ShallowNetwork::weights_of(layer, w);
  const double gain = 1.4 * std::pow(20.0, 1.0 / 15.0);
  for (Index i = 0; i < 20; ++i) {
    EXPECT_NEAR(first.col(i).tail(15).norm(), gain, 1e-12);
    const double spot = -1.0 + 2.0 * static_cast<double>(i) / 19.0;
    EXPECT_NEAR(first(0, i), gain * spot * (first(1, i) < 0.0 ? -1.0 : 1.0), 1e-12);
  }
  const auto single = ShallowNetwork::weights_of(network.layers()[1], w);
  EXPECT_EQ(single(0, 0), 0.0) << "a single unit lies in the middle";
  EXPECT_NEAR(single.col(0).tail(35).norm(), 1.4, 1e-12);
  EXPECT_LE(w.tail(network.layers()[2].size()).cwiseAbs().maxCoeff(), 1.0);
}

/// J of e = scale·(target - output) by central differences, one row per error.
Eigen::MatrixXd numeric_jacobian(const ShallowNetwork& network, const RowMatrix& x,
                                 const Eigen::VectorXd& w, const Eigen::VectorXd& scale) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd jacobian(x.rows() * scale.size(), w.size());
  for (Index p = 0; p < w.size(); ++p) {
    Eigen::VectorXd more = w, less = w;
    more[p] += kStep;
    less[p] -= kStep;
    const RowMatrix slope =
        (outputs(network, x, less) - outputs(network, x, more)) * scale.asDiagonal() / (2 * kStep);
    jacobian.col(p) = slope.reshaped<Eigen::RowMajor>();
  }
  return jacobian;
}

TEST(ShallowResiduals, NormalEquationsAreThoseOfTheNumericJacobian) {
  for (const auto& shape : kShapes) {
    const ShallowNetwork network(shape);
    Rng rng(3);
    const Eigen::VectorXd w = network.initial_weights(rng);
    const RowMatrix x = drawn_rows(37, shape.inputs, 1), t = drawn_rows(37, shape.outputs, 2);
    const Eigen::VectorXd scale = Eigen::VectorXd::LinSpaced(shape.outputs, 0.5, 3.0);
    const ShallowResiduals residuals(network, x, t, scale);
    const NormalEquations got = residuals.linearise(w);

    const Eigen::MatrixXd j = numeric_jacobian(network, x, w, scale);
    const RowMatrix errors = (t - outputs(network, x, w)) * scale.asDiagonal();
    const Eigen::VectorXd e = errors.reshaped<Eigen::RowMajor>();
    const auto n = static_cast<double>(e.size());
    const double largest = (j.transpose() * j / n).cwiseAbs().maxCoeff();
    EXPECT_LT((got.hessian - j.transpose() * j / n).cwiseAbs().maxCoeff(), 1e-8 * largest);
    EXPECT_LT((got.gradient - j.transpose() * e / n).cwiseAbs().maxCoeff(), 1e-8 * largest);
    EXPECT_NEAR(residuals.loss(w), e.squaredNorm() / n, 1e-12);
  }
}

/// The mean over rows is the mean of the means over parts of them, however they fall into chunks.
TEST(ShallowResiduals, RowsMayBeCutAnywhere) {
  const ShallowNetwork network({3, {4, 3}, 2, true});
  Rng rng(3);
  const Eigen::VectorXd w = network.initial_weights(rng), scale = Eigen::VectorXd::Ones(2);
  const Index n = 2500;
  const RowMatrix x = drawn_rows(n, 3, 1), t = drawn_rows(n, 2, 2);
  const NormalEquations whole = ShallowResiduals(network, x, t, scale).linearise(w);
  for (const Index cut : {Index{1}, Index{7}, Index{1031}, n - 1}) {
    const auto part = [&](Index first, Index rows) {
      return ShallowResiduals(network, x.middleRows(first, rows), t.middleRows(first, rows), scale)
          .linearise(w);
    };
    const NormalEquations a = part(0, cut), b = part(cut, n - cut);
    const double share = static_cast<double>(cut) / static_cast<double>(n);
    EXPECT_LT((share * a.hessian + (1.0 - share) * b.hessian - whole.hessian).norm(),
              1e-12 * whole.hessian.norm());
    EXPECT_LT((share * a.gradient + (1.0 - share) * b.gradient - whole.gradient).norm(),
              1e-12 * whole.hessian.norm());
  }
}

TEST(ShallowResiduals, ThreadsDoNotChangeABit) {
  const ShallowNetwork network({3, {4, 3}, 2, true});
  Rng rng(3);
  const Eigen::VectorXd w = network.initial_weights(rng), scale = Eigen::VectorXd::Ones(2);
  const ShallowResiduals residuals(network, drawn_rows(3000, 3, 1), drawn_rows(3000, 2, 2), scale);
  const int before = threads();
  set_threads(1);
  const NormalEquations one = residuals.linearise(w);
  const double loss = residuals.loss(w);
  set_threads(3);
  const NormalEquations three = residuals.linearise(w);
  EXPECT_EQ(one.hessian, three.hessian);
  EXPECT_EQ(one.gradient, three.gradient);
  EXPECT_EQ(loss, residuals.loss(w));
  set_threads(before);
}

}  // namespace
}  // namespace dcnn
