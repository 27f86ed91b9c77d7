// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/network_input.h"

#include <algorithm>

#include "models/sensor_columns.h"

namespace dcnn {
namespace {

constexpr double kLongestWindow = 4096;

class StreamingMap final : public StreamingInput {
 public:
  explicit StreamingMap(InputMap map)
      : map_(std::move(map)),
        cells_(static_cast<std::size_t>(map_.features() * InputMap::kColumns)) {}
  void reset() noexcept override {}
  const Real* push(const Eigen::VectorXd& x) noexcept override {
    map_.write(x.data(), cells_.data());
    return cells_.data();
  }

 private:
  InputMap map_;
  std::vector<Real> cells_;
};

/// The last rows in a ring that holds every row twice, so that a window is one piece of it.
class StreamingWindow final : public StreamingInput {
 public:
  StreamingWindow(const Eigen::VectorXd& mean, const Eigen::ArrayXd& scale, Index length)
      : mean_(mean), scale_(scale), ring_(mean.size(), 2 * length), length_(length) {}
  void reset() noexcept override { fresh_ = true; }
  const Real* push(const Eigen::VectorXd& x) noexcept override {
    next_ = fresh_ || next_ + 1 == length_ ? 0 : next_ + 1;
    auto row = ring_.col(next_);
    row = ((x - mean_).array() / scale_).matrix().cast<Real>();
    if (fresh_) {
      for (Index k = 1; k < 2 * length_; ++k) ring_.col(k) = ring_.col(0);
      fresh_ = false;
    } else {
      ring_.col(next_ + length_) = row;
    }
    return ring_.col(next_ + 1).data();
  }
  bool slides() const override { return true; }

 private:
  Eigen::VectorXd mean_;
  Eigen::ArrayXd scale_;
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> ring_;  // (F, 2T)
  Index length_, next_ = 0;
  bool fresh_ = true;
};

/// Eq. 7 of one row.
class MapInput : public NetworkInput {
 public:
  explicit MapInput(Index features) : features_(features) {}
  Shape shape() const override { return {features_, InputMap::kColumns, 1}; }
  bool per_sample() const override { return true; }
  PreparedStream prepare(const Stream& stream, const InputMap& /*map*/) const override {
    return prepare_rows(stream);
  }
  void write(const PreparedStream& stream, const InputMap& map, Index row,
             Real* out) const override {
    map.write(stream.values.row(row).data(), out);
  }
  std::unique_ptr<StreamingInput> streaming(const InputMap& map) const override {
    return std::make_unique<StreamingMap>(map);
  }
  Json to_json() const override { return {{"kind", "map"}}; }

 private:
  Index features_;
};

/// The last rows, oldest first, each feature standardised.
class WindowInput : public NetworkInput {
 public:
  WindowInput(Index features, Index length) : features_(features), length_(length) {}
  Shape shape() const override { return {length_, features_}; }
  bool per_sample() const override { return length_ == 1; }
  PreparedStream prepare(const Stream& stream, const InputMap& map) const override {
    PreparedStream prepared = prepare_rows(stream);
    prepared.values.rowwise() -= map.mean().transpose();
    prepared.values.array().rowwise() /= scale(map).transpose();
    return prepared;
  }
  void write(const PreparedStream& stream, const InputMap& /*map*/, Index row,
             Real* out) const override {
    const Index begin = stream.segment_begin[static_cast<std::size_t>(row)];
    for (Index k = 0; k < length_; ++k) {
      const double* x = stream.values.row(std::max(begin, row - length_ + 1 + k)).data();
      for (Index j = 0; j < features_; ++j) *out++ = static_cast<Real>(x[j]);
    }
  }
  std::unique_ptr<StreamingInput> streaming(const InputMap& map) const override {
    return std::make_unique<StreamingWindow>(map.mean(), scale(map), length_);
  }
  Json to_json() const override { return {{"kind", "window"}, {"length", length_}}; }

 private:
  static Eigen::ArrayXd scale(const InputMap& map) {
    return (map.deviation().array() < 1e-12).select(1.0, map.deviation());
  }

  Index features_, length_;
};

const std::vector<std::string> kInputKinds{"map", "window", "body", "lines"};

bool is_sensor(const std::string& kind) { return kind == "body" || kind == "lines"; }

/// The kinds without statistics of their own.
std::unique_ptr<NetworkInput> simple(const std::string& kind, Options& options, Index features) {
  if (kind == "map") return std::make_unique<MapInput>(features);
  const auto length = static_cast<Index>(options.number("length", 1, 1, kLongestWindow));
  return std::make_unique<WindowInput>(features, length);
}

}  // namespace

PreparedStream prepare_rows(const Stream& stream) { return {stream.x, stream.segment_begins()}; }

std::unique_ptr<NetworkInput> make_input(const Json& json, const FeatureLayout& layout,
                                         const std::string& where) {
  Options options(json, where, Exit::kUsage);
  if (!options.has("kind")) options.reject("kind", "is missing");
  const auto kind = options.choice("kind", "map", kInputKinds);
  std::unique_ptr<NetworkInput> input;
  if (is_sensor(kind)) {
    input = std::make_unique<SensorColumns>(kind, options, layout);
  } else {
    input = simple(kind, options, static_cast<Index>(layout.names.size()));
  }
  options.finish();
  return input;
}

std::unique_ptr<NetworkInput> stored_input(const Json& json, Index features,
                                           const std::string& where) {
  Options options(json, where, Exit::kModel);
  if (!options.has("kind")) options.reject("kind", "is missing");
  const auto kind = options.choice("kind", "map", kInputKinds);
  std::unique_ptr<NetworkInput> input;
  if (is_sensor(kind)) {
    input = std::make_unique<SensorColumns>(kind, options, features, where);
  } else {
    input = simple(kind, options, features);
  }
  options.finish();
  return input;
}

}  // namespace dcnn
