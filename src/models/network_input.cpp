#include "dcnn/models/network_input.h"

#include <algorithm>

namespace dcnn {
namespace {

constexpr double kLongestWindow = 4096;

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
    const Eigen::ArrayXd scale = (map.deviation().array() < 1e-12).select(1.0, map.deviation());
    prepared.values.rowwise() -= map.mean().transpose();
    prepared.values.array().rowwise() /= scale.transpose();
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
  Json to_json() const override { return {{"kind", "window"}, {"length", length_}}; }

 private:
  Index features_, length_;
};

}  // namespace

PreparedStream prepare_rows(const Stream& stream) {
  PreparedStream prepared{stream.x, std::vector<Index>(static_cast<std::size_t>(stream.rows()), 0)};
  for (const Segment& segment : stream.segments) {
    std::fill(prepared.segment_begin.begin() + segment.begin,
              prepared.segment_begin.begin() + segment.end, segment.begin);
  }
  return prepared;
}

std::unique_ptr<NetworkInput> make_input(const Json& json, Index features, const std::string& where,
                                         Exit exit) {
  Options options(json, where, exit);
  if (!options.has("kind")) options.reject("kind", "is missing");
  const auto kind = options.choice("kind", "map", {"map", "window"});
  std::unique_ptr<NetworkInput> input;
  if (kind == "map") input = std::make_unique<MapInput>(features);
  if (kind == "window") {
    const auto length = static_cast<Index>(options.number("length", 1, 1, kLongestWindow));
    input = std::make_unique<WindowInput>(features, length);
  }
  options.finish();
  return input;
}

}  // namespace dcnn
