#include "models/linear_skip.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

LinearSkip LinearSkip::fit(const Samples& training, const NoiseSpec& noise, const InputMap& map,
                           const NetworkInput& input, std::uint64_t seed) {
  const Index columns = 1 + element_count(input.shape()), targets = training.y.cols();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(columns, columns);
  Eigen::MatrixXd moment = Eigen::MatrixXd::Zero(columns, targets);
  double rows = 0.0;
  for (std::size_t level = 0; level < noise.levels.size(); ++level) {
    const auto key = Rng({seed, kSkipNoise, level}).bits();
    const PreparedStream stream =
        input.prepare(noisy(training, noise, map, noise.levels[level], key), map);
    for (Index first = 0; first < training.rows(); first += kSkipRows) {
      const Index n = std::min(kSkipRows, training.rows() - first);
      const Eigen::MatrixXd a = design(input, stream, map, first, n);
      normal.noalias() += a.transpose() * a;
      moment.noalias() += a.transpose() * training.y.middleRows(first, n);
      rows += static_cast<double>(n);
    }
  }
  Eigen::MatrixXd raised = normal;
  raised.diagonal().tail(columns - 1).array() += kRidge * rows;
  LinearSkip skip;
  skip.weights_ = raised.llt().solve(moment);
  require(skip.weights_.allFinite(), Exit::kFailure,
          "the linear part could not be fitted: a feature is not finite");
  // |Y - AW|^2 = |Y|^2 - 2 W^T A^T Y + W^T A^T A W, column by column.
  const Eigen::VectorXd squares =
      training.y.colwise().squaredNorm().transpose() * static_cast<double>(noise.levels.size());
  const Eigen::MatrixXd& w = skip.weights_;
  const Eigen::VectorXd left = squares - 2.0 * w.cwiseProduct(moment).colwise().sum().transpose() +
                               w.cwiseProduct(normal * w).colwise().sum().transpose();
  const Eigen::VectorXd least = 1e-12 * squares;  // rounding
  skip.residual_ = (left.cwiseMax(least) / rows).cwiseSqrt();
  return skip;
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
