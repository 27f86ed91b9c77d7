// SPDX-License-Identifier: Apache-2.0
#include "models/linear_skip.h"

#include <algorithm>
#include <cmath>

#include "core/linear_algebra.h"
#include "dcnn/core/random.h"
#include "models/random_streams.h"
#include "models/tensor_io.h"

namespace dcnn {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr Index kSkipRows = 1024;
constexpr const char* kName = "skip.weights";

/// [1, inputs] of some rows, as the network sees them.
Eigen::MatrixXd design(const NetworkInput& input, const PreparedStream& stream, const InputMap& map,
                       Index first, Index rows) {
  std::vector<Real> cells(static_cast<std::size_t>(element_count(input.shape())));
  Eigen::MatrixXd a(rows, 1 + static_cast<Index>(cells.size()));
  for (Index i = 0; i < rows; ++i) {
    input.write(stream, map, first + i, cells.data());
    a(i, 0) = 1.0;
    for (std::size_t j = 0; j < cells.size(); ++j) {
      a(i, 1 + static_cast<Index>(j)) = static_cast<double>(cells[j]);
    }
  }
  return a;
}

/// The sums that least squares needs of the rows at one level of noise.
LinearSkip::Gram gram_of(const PreparedStream& stream, const Samples& training, const InputMap& map,
                         const NetworkInput& input) {
  const Index columns = 1 + element_count(input.shape()), targets = training.y.cols();
  LinearSkip::Gram gram{
      Eigen::MatrixXd::Zero(columns, columns), Eigen::MatrixXd::Zero(columns, targets),
      training.y.colwise().squaredNorm().transpose(), static_cast<double>(training.rows())};
  for (Index first = 0; first < training.rows(); first += kSkipRows) {
    const Index n = std::min(kSkipRows, training.rows() - first);
    const Eigen::MatrixXd a = design(input, stream, map, first, n);
    gram.inputs.noalias() += a.transpose() * a;
    gram.moment.noalias() += a.transpose() * training.y.middleRows(first, n);
  }
  return gram;
}

std::vector<LinearSkip::Gram> grams_of(const Samples& training, const NoiseSpec& noise,
                                       const InputMap& map, const NetworkInput& input,
                                       std::uint64_t seed) {
  std::vector<LinearSkip::Gram> grams;
  for (std::size_t level = 0; level < noise.levels.size(); ++level) {
    const auto key = Rng({seed, kSkipNoise, level}).bits();
    grams.push_back(
        gram_of(input.prepare(noisy(training, noise, map, noise.levels[level], key), map), training,
                map, input));
  }
  return grams;
}

}  // namespace

LinearSkip LinearSkip::fit(const Samples& training, const NoiseSpec& noise, const InputMap& map,
                           const NetworkInput& input, std::uint64_t seed) {
  const std::vector<Gram> grams = grams_of(training, noise, map, input, seed);
  LinearSkip skip;
  skip.level_weights_.assign(grams.size(), 1.0);
  skip.solve(grams);
  skip.weigh(grams);
  skip.solve(grams);
  skip.weigh(grams);
  return skip;
}

void LinearSkip::solve(const std::vector<Gram>& grams) {
  Eigen::MatrixXd normal = 0.0 * grams.front().inputs, moment = 0.0 * grams.front().moment;
  double rows = 0.0;
  for (std::size_t k = 0; k < grams.size(); ++k) {
    normal += level_weights_[k] * grams[k].inputs;
    moment += level_weights_[k] * grams[k].moment;
    rows += level_weights_[k] * grams[k].rows;
  }
  normal.diagonal().tail(normal.rows() - 1).array() += kRidge * rows;
  const auto weights = solve_definite(normal, moment);
  require(weights && weights->allFinite(), Exit::kFailure,
          "the linear part could not be fitted: a feature is not finite");
  weights_ = *weights;
}

void LinearSkip::weigh(const std::vector<Gram>& grams) {
  // |Y - AW|^2 = |Y|^2 - 2 W^T A^T Y + W^T A^T A W, column by column.
  Eigen::MatrixXd left(weights_.cols(), static_cast<Index>(grams.size()));
  for (std::size_t k = 0; k < grams.size(); ++k) {
    const Gram& g = grams[k];
    const Eigen::VectorXd squares =
        g.targets - 2.0 * weights_.cwiseProduct(g.moment).colwise().sum().transpose() +
        weights_.cwiseProduct(g.inputs * weights_).colwise().sum().transpose();
    left.col(static_cast<Index>(k)) = squares.cwiseMax(1e-12 * g.targets) / g.rows;  // rounding
  }
  const Eigen::VectorXd inverse = left.colwise().mean().cwiseSqrt().cwiseInverse();
  for (std::size_t k = 0; k < grams.size(); ++k) {
    level_weights_[k] = inverse[static_cast<Index>(k)] / inverse.mean();
  }
  const Eigen::Map<const Eigen::VectorXd> w(level_weights_.data(), left.cols());
  residual_ = (left * w / w.sum()).cwiseSqrt();
}

Eigen::MatrixXd LinearSkip::of(const Tensor& inputs) const {
  const Index n = inputs.dim(0), cells = weights_.rows() - 1;
  Eigen::MatrixXd result(n, targets());
  Eigen::VectorXd row(targets());
  for (Index i = 0; i < n; ++i) {
    of(inputs.data() + i * cells, row);
    result.row(i) = row.transpose();
  }
  return result;
}

void LinearSkip::of(const Real* inputs, Eigen::VectorXd& y) const noexcept {
  const Index cells = weights_.rows() - 1;
  for (Index j = 0; j < targets(); ++j) {
    double sum = weights_(0, j);
    for (Index k = 0; k < cells; ++k) sum += weights_(1 + k, j) * static_cast<double>(inputs[k]);
    y[j] = sum;
  }
}

void LinearSkip::save(Container& file) const {
  const RowMajor rows = weights_;
  file.tensors.push_back({kName,
                          {rows.rows(), rows.cols()},
                          std::vector<double>(rows.data(), rows.data() + rows.size())});
}

LinearSkip LinearSkip::load(const Container& file, Index cells, const std::string& where) {
  const auto& values = stored_values<double>(file, kName, where);
  const auto& shape = file.find(kName)->shape;
  require(shape.size() == 2 && shape[0] == 1 + cells && shape[1] >= 1, Exit::kModel, where,
          ": its linear part does not fit its inputs");
  LinearSkip skip;
  skip.weights_ = Eigen::Map<const RowMajor>(values.data(), shape[0], shape[1]);
  skip.residual_ = Eigen::VectorXd::Ones(shape[1]);
  return skip;
}

}  // namespace dcnn
