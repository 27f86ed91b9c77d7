// SPDX-License-Identifier: Apache-2.0
#include "models/sensor_columns.h"

#include <algorithm>
#include <cmath>

#include "dcnn/data/line_filter.h"
#include "physics/vectors.h"

namespace dcnn {
namespace {

constexpr double kLeastSaturated = 0.3;  // deviation of a tanh entry
constexpr std::size_t kMostLines = 12;
constexpr double kConstant = 1e-9;   // a deviation below this share of the mean is rounding
constexpr Index kLongest = 1 << 16;  // samples in a window

using RowMajor = decltype(PreparedStream::values);

/// Column c of every channel.
void set_column(RowMajor& values, Index c, const Eigen::MatrixXd& column) {
  const Index columns = values.cols() / column.cols();
  for (Index j = 0; j < column.cols(); ++j) {
    values.col(j * columns + c) = column.col(j);
  }
}

Eigen::RowVectorXd deviation_of(const Eigen::MatrixXd& values, const Eigen::RowVectorXd& mean) {
  const double n = static_cast<double>(std::max<Index>(1, values.rows() - 1));
  const Eigen::RowVectorXd sd = ((values.rowwise() - mean).colwise().squaredNorm() / n).cwiseSqrt();
  const Eigen::RowVectorXd least = kConstant * (mean.array().abs() + kConstant).matrix();
  return (sd.array() > least.array()).select(sd, 1.0);
}

Eigen::VectorXd read_vector(Options& options, const std::string& key, Index size) {
  const auto v = options.get<std::vector<double>>(key);
  const Eigen::VectorXd result =
      Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Index>(v.size()));
  if (result.size() != size || !result.allFinite()) {
    options.reject(key, "must hold ", size, " finite numbers");
  }
  return result;
}

}  // namespace

SensorColumns::SensorColumns(const std::string& kind, Options& options, const FeatureLayout& layout)
    : features_(static_cast<Index>(layout.names.size())), frame_(layout) {
  if (kind == "body") return;
  const auto windows =
      options.get("windows_s", std::vector<double>{0.016, 0.048, 0.128, 0.256, 0.512});
  if (windows.size() < kSaturatedLine + 1 || windows.size() > kMostLines) {
    options.reject("windows_s", "must be ", kSaturatedLine + 1, " to ", kMostLines,
                   " lengths in s");
  }
  if (layout.dt <= 0.0) {
    options.reject("kind", "is 'lines', which needs recordings with a clock; use 'body'");
  }
  for (const double window : windows) {
    const double samples = std::round(window / layout.dt);
    if (!(samples >= 2.0 && samples <= static_cast<double>(kLongest))) {
      options.reject("windows_s", "must be lengths of 2 to ", kLongest, " samples of ", layout.dt,
                     " s, not ", window, " s");
    }
    lengths_.push_back(static_cast<Index>(samples));
  }
  adaptive_ = options.get("adaptive", true);
  // Angles are logged as they are, rates come smoothed out of the derivative's window.
  level_channels_ = frame_.to_json().is_null() ? features_ : 3;
}

SensorColumns::SensorColumns(const std::string& kind, Options& options, Index features,
                             const std::string& where)
    : features_(features),
      frame_(SensorFrame::parse(options.raw("frame"), features, where, Exit::kModel)) {
  if (kind == "lines") {
    lengths_ = options.get<std::vector<Index>>("line_lengths");
    const bool valid =
        lengths_.size() > kSaturatedLine && lengths_.size() <= kMostLines &&
        std::ranges::all_of(lengths_, [](Index n) { return n > 1 && n <= kLongest; });
    if (!valid) options.reject("line_lengths", "must be numbers of samples");
    const Json mixture = options.raw("mixture");
    adaptive_ = !mixture.is_null();
    if (adaptive_) {
      mixture_ = LineMixture::parse(mixture, features, static_cast<Index>(lengths_.size()), where);
    }
  }
  channel_mean_ = read_vector(options, "channel_mean", features);
  knee_ = read_vector(options, "knee", features);
  mean_ = read_vector(options, "mean", columns() * features).transpose();
  deviation_ = read_vector(options, "deviation", columns() * features).transpose();
  if ((knee_.array() <= 0.0).any()) options.reject("knee", "must be above 0");
  if ((deviation_.array() <= 0.0).any()) options.reject("deviation", "must be above 0");
}

void SensorColumns::learn(const Samples& training, const InputMap& map, const NoiseSpec& noise) {
  const Eigen::MatrixXd channels = frame_.of(training.x);
  channel_mean_ = channels.colwise().mean().transpose();
  knee_ = kKnee * deviation_of(channels, channel_mean_.transpose()).transpose();
  if (adaptive_) {
    mixture_ = LineMixture::learn(training, noise, map, lengths_, level_channels_);
  }
  const RowMajor entries = raw(training).values;
  mean_ = entries.colwise().mean();
  deviation_ = deviation_of(entries, mean_);
  for (Index j = saturated_column(); j < deviation_.size(); j += columns()) {
    deviation_[j] = std::max(deviation_[j], kLeastSaturated);
  }
}

PreparedStream SensorColumns::raw(const Stream& stream) const {
  PreparedStream prepared = prepare_rows(stream);
  RowMajor& entries = prepared.values;
  entries.resize(stream.rows(), columns() * features_);
  const Eigen::RowVectorXd mean = channel_mean_.transpose(), knee = knee_.transpose();
  const auto saturated = [&](const Eigen::MatrixXd& values) {
    return (values.array().rowwise() / knee.array()).tanh().matrix().eval();
  };
  if (!is_lines()) {
    const Eigen::MatrixXd x = frame_.of(stream.x);
    set_column(entries, 0, x);
    set_column(entries, 1, x.rowwise() - mean);
    set_column(entries, 2,
               ((x.rowwise() - mean).array().rowwise() / knee.array() * kKnee).matrix());
    set_column(entries, 3, saturated(x));
    set_column(entries, 4, x.cwiseAbs2());
    return prepared;
  }
  std::vector<Eigen::MatrixXd> lines;
  for (std::size_t k = 0; k < lengths_.size(); ++k) {
    lines.push_back(line_filtered(stream.x, prepared.segment_begin, lengths_[k]));
    const Eigen::MatrixXd turned = frame_.of(lines.back());
    set_column(entries, static_cast<Index>(k), turned);
    if (!adaptive_ && k == kSaturatedLine) {
      set_column(entries, saturated_column(), saturated(turned));
    }
  }
  if (!adaptive_) return prepared;
  const Eigen::MatrixXd mixed = frame_.of(mixture_.of(stream.x, prepared.segment_begin, lines));
  set_column(entries, saturated_column() - 1, mixed);
  set_column(entries, saturated_column(), saturated(mixed));
  return prepared;
}

PreparedStream SensorColumns::prepare(const Stream& stream, const InputMap& /*map*/) const {
  PreparedStream prepared = raw(stream);
  auto& values = prepared.values;
  for (Index i = 0; i < values.rows(); ++i) {
    values.row(i) =
        ((values.row(i) - mean_).array() / deviation_.array()).cwiseMax(-kClip).cwiseMin(kClip);
  }
  return prepared;
}

void SensorColumns::write(const PreparedStream& stream, const InputMap& /*map*/, Index row,
                          Real* out) const {
  const auto values = stream.values.row(row);
  for (Index j = 0; j < values.size(); ++j) out[j] = static_cast<Real>(values[j]);
}

Json SensorColumns::to_json() const {
  Json json = {
      {"kind", is_lines() ? "lines" : "body"},  {"frame", frame_.to_json()},
      {"channel_mean", to_list(channel_mean_)}, {"knee", to_list(knee_)},
      {"mean", to_list(mean_.transpose())},     {"deviation", to_list(deviation_.transpose())}};
  if (is_lines()) json["line_lengths"] = lengths_;
  if (adaptive_) json["mixture"] = mixture_.to_json();
  return json;
}

}  // namespace dcnn
