// SPDX-License-Identifier: Apache-2.0
#include "models/line_mixture.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/linear_algebra.h"
#include "dcnn/core/random.h"
#include "dcnn/data/line_filter.h"
#include "models/random_streams.h"
#include "physics/vectors.h"

namespace dcnn {
namespace {

constexpr double kLeastSquare = 1e-16;  // of a second difference in units of the spread
constexpr double kRidge = 1e-4;
constexpr Index kMostLevels = 64;

/// The noise that the mixture is made for, whatever the network beside it is trained with.
const std::vector<SnrLevel>& made_for() {
  static const std::vector<SnrLevel> levels{std::nullopt, 60, 50, 45, 40, 35, 30, 25, 20, 15, 10};
  return levels;
}

/// Levels of every row.
Eigen::VectorXd levels_of(const Eigen::MatrixXd& x, const std::vector<Index>& segment_begin,
                          NoiseLevel level) {
  Eigen::VectorXd result(x.rows());
  Eigen::RowVectorXd row;
  for (Index i = 0; i < x.rows(); ++i) {
    if (segment_begin[static_cast<std::size_t>(i)] == i) level.restart();
    row = x.row(i);
    result[i] = level.push(row);
  }
  return result;
}

double mean_of_known(const Eigen::VectorXd& levels) {
  double sum = 0.0, known = 0.0;
  for (const double level : levels) {
    if (level == NoiseLevel::kUnknown) continue;
    sum += level;
    known += 1.0;
  }
  return known > 0.0 ? sum / known : 0.0;
}

Eigen::RowVectorXd spread_of(const Eigen::MatrixXd& x, const Eigen::RowVectorXd& mean) {
  const Eigen::RowVectorXd spread =
      (x.rowwise() - mean).array().square().colwise().mean().sqrt().matrix();
  return (spread.array() > 1e-12).select(spread, 1.0);
}

Eigen::VectorXd read(Options& options, const char* key) {
  const auto v = options.get<std::vector<double>>(key);
  Eigen::VectorXd result =
      Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Index>(v.size()));
  if (!result.allFinite()) options.reject(key, "must hold finite numbers");
  return result;
}

}  // namespace

NoiseLevel::NoiseLevel(Eigen::VectorXd scale)
    : scale_(std::move(scale)),
      before_(Eigen::VectorXd::Zero(scale_.size())),
      second_before_(before_),
      square_(before_) {}

double NoiseLevel::push(const Eigen::RowVectorXd& row) noexcept {
  double sum = 0.0;
  const Index differences = count_ - 1;  // with this row's own
  const double share = 1.0 / static_cast<double>(std::clamp<Index>(differences, 1, kSpan));
  for (Index c = 0; c < scale_.size(); ++c) {
    const double bend = (row[c] - 2.0 * before_[c] + second_before_[c]) / scale_[c];
    if (differences < 1) square_[c] = 0.0;
    if (differences >= 1) square_[c] += share * (bend * bend - square_[c]);
    second_before_[c] = before_[c];
    before_[c] = row[c];
    sum += 0.5 * std::log10(square_[c] + kLeastSquare);
  }
  ++count_;
  return differences < kFewest ? kUnknown : sum / static_cast<double>(scale_.size());
}

LineMixture LineMixture::learn(const Samples& training, const NoiseSpec& noise, const InputMap& map,
                               const std::vector<Index>& lengths, Index channels) {
  const Index features = training.x.cols(), windows = static_cast<Index>(lengths.size());
  const auto count = static_cast<Index>(made_for().size());
  LineMixture mixture;
  const Eigen::RowVectorXd mean = training.x.colwise().mean();
  const Eigen::RowVectorXd spread = spread_of(training.x, mean);
  mixture.mean_ = mean.transpose();
  mixture.scale_ = spread.head(channels).transpose();
  Eigen::VectorXd levels(count);
  Eigen::MatrixXd weights(count, windows * features);
  const auto begins = training.segment_begins();
  const Eigen::MatrixXd clean = training.x.rowwise() - mean;
  for (Index k = 0; k < count; ++k) {
    const auto key = Rng({kMixtureNoise, static_cast<std::uint64_t>(k)}).bits();
    const Stream noisy_rows =
        noisy(training, noise, map, made_for()[static_cast<std::size_t>(k)], key);
    levels[k] = mean_of_known(levels_of(noisy_rows.x, begins, mixture.noise_level()));
    std::vector<Eigen::MatrixXd> lines;
    for (const Index length : lengths) {
      lines.push_back(line_filtered(noisy_rows.x, begins, length).rowwise() - mean);
    }
    Eigen::MatrixXd past(training.rows(), windows);
    for (Index c = 0; c < features; ++c) {
      for (Index w = 0; w < windows; ++w) past.col(w) = lines[static_cast<std::size_t>(w)].col(c);
      Eigen::MatrixXd normal = past.transpose() * past;
      normal.diagonal().array() +=
          kRidge * static_cast<double>(training.rows()) * spread[c] * spread[c];
      weights.row(k).segment(c * windows, windows) =
          solve_definite(normal, past.transpose() * clean.col(c)).value().transpose();
    }
  }
  std::vector<Index> rising(static_cast<std::size_t>(count));
  std::iota(rising.begin(), rising.end(), Index{0});
  std::ranges::sort(rising, {}, [&](Index k) { return levels[k]; });
  mixture.levels_ = levels(rising);
  mixture.weights_ = weights(rising, Eigen::all);
  return mixture;
}

void LineMixture::mix(const Eigen::MatrixXd& lines, double level,
                      Eigen::RowVectorXd& mixed) const noexcept {
  const Index last = levels_.size() - 1, windows = lines.rows();
  Index high = 0;
  while (high < last && levels_[high] < level) ++high;
  const Index low = std::max<Index>(0, high - 1);
  const double gap = std::max(levels_[high] - levels_[low], 1e-9);
  const double share = std::clamp((level - levels_[low]) / gap, 0.0, 1.0);
  for (Index c = 0; c < mean_.size(); ++c) {
    double sum = mean_[c];
    for (Index w = 0; w < windows; ++w) {
      const Index j = c * windows + w;
      const double weight = (1.0 - share) * weights_(low, j) + share * weights_(high, j);
      sum += weight * (lines(w, c) - mean_[c]);
    }
    mixed[c] = sum;
  }
}

Eigen::MatrixXd LineMixture::of(const Eigen::MatrixXd& x, const std::vector<Index>& segment_begin,
                                const std::vector<Eigen::MatrixXd>& lines) const {
  const Eigen::VectorXd levels = levels_of(x, segment_begin, noise_level());
  Eigen::MatrixXd result(x.rows(), x.cols());
  Eigen::MatrixXd own(static_cast<Index>(lines.size()), x.cols());
  Eigen::RowVectorXd mixed(x.cols());
  for (Index i = 0; i < x.rows(); ++i) {
    for (std::size_t w = 0; w < lines.size(); ++w) own.row(static_cast<Index>(w)) = lines[w].row(i);
    mix(own, levels[i], mixed);
    result.row(i) = mixed;
  }
  return result;
}

Json LineMixture::to_json() const {
  return {{"scale", to_list(scale_)},
          {"mean", to_list(mean_)},
          {"levels", to_list(levels_)},
          {"weights", to_list(weights_.reshaped())}};
}

LineMixture LineMixture::parse(const Json& json, Index features, Index windows,
                               const std::string& where) {
  Options options(json, where, Exit::kModel);
  LineMixture mixture;
  mixture.scale_ = read(options, "scale");
  mixture.mean_ = read(options, "mean");
  mixture.levels_ = read(options, "levels");
  const Eigen::VectorXd weights = read(options, "weights");
  options.finish();
  const Index count = mixture.levels_.size();
  require(count >= 1 && count <= kMostLevels && mixture.mean_.size() == features &&
              mixture.scale_.size() >= 1 && mixture.scale_.size() <= features &&
              (mixture.scale_.array() > 0.0).all() &&
              weights.size() == count * windows * features &&
              std::is_sorted(mixture.levels_.begin(), mixture.levels_.end()),
          Exit::kModel, where, ": the mixture of its lines does not fit its features");
  mixture.weights_ = Eigen::Map<const Eigen::MatrixXd>(weights.data(), count, windows * features);
  return mixture;
}

}  // namespace dcnn
