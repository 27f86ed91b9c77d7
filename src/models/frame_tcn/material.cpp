// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/material.h"

#include <algorithm>

namespace dcnn::frame_tcn {

Stream at_speed(const Stream& motion, double speed) {
  Stream out;
  std::vector<Eigen::MatrixXd> parts;
  Index total = 0;
  for (const Segment& s : stretches(motion.rows(), motion.segments)) {
    const auto rows = 1 + static_cast<Index>(static_cast<double>(s.size() - 1) / speed);
    Eigen::MatrixXd part(rows, kChannels);
    for (Index i = 0; i < rows; ++i) {
      const double place = static_cast<double>(i) * speed;
      const Index low = s.begin + std::min<Index>(static_cast<Index>(place), s.size() - 1);
      const Index high = std::min(low + 1, s.end - 1);
      const double share = place - std::floor(place);
      part.row(i) = (1.0 - share) * motion.x.row(low) + share * motion.x.row(high);
    }
    part.middleCols<6>(3) *= speed;        // v, theta'
    part.rightCols<6>() *= speed * speed;  // a, theta''
    out.segments.push_back({total, total + rows});
    total += rows;
    parts.push_back(std::move(part));
  }
  out.x.resize(total, kChannels);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    out.x.middleRows(out.segments[k].begin, out.segments[k].size()) = parts[k];
  }
  return out;
}

Eigen::MatrixXd normalised(const Eigen::MatrixXd& x, const Eigen::VectorXd& mean,
                           const Eigen::VectorXd& scale) {
  return (x.rowwise() - mean.transpose()).array().rowwise() / scale.transpose().array();
}

Material::Material(const Front& front, const Eigen::MatrixXd& x,
                   const std::vector<Segment>& segments, Index stride, Index edge) {
  constexpr Index kBatch = 512;
  const BlockMeans blocks(x, segments);
  const Eigen::MatrixXd rough = dcnn::frame_tcn::roughness(x, x, segments, edge);
  const Index rows = x.rows() / stride;
  experts.resize(kChannels * front.experts, rows);
  roughness.resize(kChannels, rows);
  clean.resize(kChannels, rows);
  for (Index i = 0; i < rows; ++i) {
    roughness.col(i) = rough.col(i * stride).cast<float>();
    clean.col(i) = x.row(i * stride).transpose().cast<float>();
  }
  if (stride == 1) {
    const Index pieces = (rows + kBatch - 1) / kBatch;
    for_each_piece(pieces, [&](Index k) {
      const Index first = k * kBatch, count = std::min(kBatch, rows - first);
      experts.middleCols(first, count) = front.apply(blocks, first, count).cast<float>();
    });
    return;
  }
  for (Index i = 0; i < rows; ++i) {
    experts.col(i) = front.apply(blocks, i * stride, 1).cast<float>();
  }
}

}  // namespace dcnn::frame_tcn
