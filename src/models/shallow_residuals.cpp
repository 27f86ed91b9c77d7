// SPDX-License-Identifier: Apache-2.0
#include "models/shallow_residuals.h"

#include <algorithm>
#include <array>
#include <utility>

namespace dcnn {
namespace {

constexpr Index kPieces = 8;
constexpr Index kChunk = 64;  // rows whose products stay in the cache

}  // namespace

ShallowResiduals::ShallowResiduals(const ShallowNetwork& network, RowMatrix inputs,
                                   RowMatrix targets, const Eigen::VectorXd& scale)
    : network_(network),
      inputs_(std::move(inputs)),
      targets_(std::move(targets)),
      scale_(scale),
      blocks_(network, scale) {}

template <class Work>
void ShallowResiduals::for_each_chunk(const Eigen::VectorXd& weights, const Work& work) const {
  const Index rows = inputs_.rows();
  for_each_piece(kPieces, [&](Index piece) {
    const Index end = piece_begin(rows, kPieces, piece + 1);
    for (Index first = piece_begin(rows, kPieces, piece); first < end; first += kChunk) {
      const Index n = std::min(kChunk, end - first);
      RowMatrix signals(n, network_.signals());
      signals.leftCols(inputs_.cols()) = inputs_.middleRows(first, n);
      RowMatrix errors = targets_.middleRows(first, n) - network_.forward(weights, signals);
      errors.array().rowwise() *= scale_.transpose().array();
      work(piece, signals, errors);
    }
  });
}

double ShallowResiduals::loss(const Eigen::VectorXd& weights) const {
  std::array<double, kPieces> sums{};
  for_each_chunk(weights, [&](Index piece, const RowMatrix&, const RowMatrix& errors) {
    sums[static_cast<std::size_t>(piece)] += errors.squaredNorm();
  });
  double sum = 0.0;
  for (const double part : sums) sum += part;
  return sum / count();
}

NormalEquations ShallowResiduals::linearise(const Eigen::VectorXd& weights) const {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(blocks_.size(), kPieces);
  for_each_chunk(weights, [&](Index piece, const RowMatrix& signals, const RowMatrix& errors) {
    blocks_.add(weights, signals, errors, sums.col(piece).data());
  });
  for (Index piece = 1; piece < kPieces; ++piece) sums.col(0) += sums.col(piece);
  NormalEquations equations;
  blocks_.unpack(weights, sums.data(), equations.hessian, equations.gradient);
  equations.hessian /= count();
  equations.gradient /= -count();  // J of the errors is minus that of the outputs
  return equations;
}

}  // namespace dcnn
