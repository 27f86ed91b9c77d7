// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/blocks.h"

#include <algorithm>

namespace dcnn::frame_tcn {
namespace {

constexpr Index kFirst = 16;  // rows whose mean stands for those before a segment

}  // namespace

std::vector<Segment> stretches(Index rows, const std::vector<Segment>& segments) {
  return segments.empty() ? std::vector<Segment>{{0, rows}} : segments;
}

BlockMeans::BlockMeans(const Eigen::MatrixXd& x, const std::vector<Segment>& segments)
    : x_(x),
      sum_(Eigen::MatrixXd::Zero(x.rows() + 1, x.cols())),
      begin_(static_cast<std::size_t>(x.rows()), 0) {
  for (Index j = 0; j < x.cols(); ++j) {
    for (Index i = 0; i < x.rows(); ++i) sum_(i + 1, j) = sum_(i, j) + x(i, j);
  }
  for (const Segment& s : segments) {
    std::fill(begin_.begin() + s.begin, begin_.begin() + s.end, s.begin);
  }
}

Index known_blocks(Index rows) {
  Index count = 0;
  for (Index covered = 0; count < kBlocks; ++count) {
    covered += block_size(count);
    if (covered > rows) break;
  }
  return count;
}

Index BlockMeans::known(Index row) const {
  return known_blocks(row + 1 - begin_[static_cast<std::size_t>(row)]);
}

void BlockMeans::write(Index row, Index channel, Index count, double* out) const {
  const Index begin = begin_[static_cast<std::size_t>(row)];
  const Index known_first = std::min(begin + kFirst, row + 1);
  const double first = (sum_(known_first, channel) - sum_(begin, channel)) /
                       static_cast<double>(known_first - begin);
  Index high = row + 1;
  for (Index k = 0; k < count; ++k) {
    const Index size = block_size(k), low = high - size;
    const Index missing = std::clamp<Index>(begin - low, 0, size);
    const double known = sum_(std::max(high, begin), channel) - sum_(std::max(low, begin), channel);
    out[k] = (known + static_cast<double>(missing) * first) / static_cast<double>(size);
    high = low;
  }
}

Eigen::MatrixXd roughness(const Eigen::MatrixXd& u, const Eigen::MatrixXd& w,
                          const std::vector<Segment>& segments, Index edge, Index fewest) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Constant(u.cols(), u.rows(), kUnknown);
  for (const Segment& s : stretches(u.rows(), segments)) {
    Eigen::VectorXd sum(s.size() + 1);
    for (Index j = 0; j < u.cols(); ++j) {
      const auto bend = [&](const Eigen::MatrixXd& x, Index i) {
        return x(i, j) - 2.0 * x(i - 1, j) + x(i - 2, j);
      };
      const Index begin = j < 3 ? 2 : edge + 2;
      sum[0] = 0.0;
      for (Index i = 0; i < s.size(); ++i) {
        sum[i + 1] = sum[i] + (i < begin ? 0.0 : bend(u, s.begin + i) * bend(w, s.begin + i));
        const Index low = std::max(begin, i + 1 - kLevelSpan);
        if (i + 1 - low >= fewest) {
          result(j, s.begin + i) = (sum[i + 1] - sum[low]) / static_cast<double>(i + 1 - low);
        }
      }
    }
  }
  return result;
}

Eigen::MatrixXd levels(const Eigen::MatrixXd& mean_square) { return level(mean_square); }

}  // namespace dcnn::frame_tcn
