// SPDX-License-Identifier: Apache-2.0
// What a network sees of a stream: the map of Eq. 7 of one row, a window of rows, columns of
// filters.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dcnn/core/tensor.h"
#include "dcnn/models/model.h"

namespace dcnn {

/// A stream as a NetworkInput reads it, made once for all the inputs that share its rows.
struct PreparedStream {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values;  ///< (N, any)
  std::vector<Index> segment_begin;  ///< (N) first row of the segment each row lies in
};

/// A network's input as rows come one by one.
class StreamingInput {
 public:
  virtual ~StreamingInput() = default;
  /// The next row begins a segment.
  virtual void reset() noexcept = 0;
  /// The input (element_count(shape())) at the row x (F), valid until the next call. Allocates,
  /// locks and throws nothing.
  virtual const Real* push(const Eigen::VectorXd& x) noexcept = 0;
  /// The input is a window of rows as Plan::slide() takes it.
  virtual bool slides() const { return false; }
};

class NetworkInput {
 public:
  virtual ~NetworkInput() = default;
  /// Of one sample: (H, W, C) or (T, F).
  virtual Shape shape() const = 0;
  /// The input of a row is made of that row alone.
  virtual bool per_sample() const { return false; }
  /// Statistics of its own, from training rows alone; those of the features are in the map, `noise`
  /// is what may be expected on them.
  virtual void learn(const Samples& /*training*/, const InputMap& /*map*/,
                     const NoiseSpec& /*noise*/) {}
  virtual PreparedStream prepare(const Stream& stream, const InputMap& map) const = 0;
  /// Writes the network's input for one row.
  virtual void write(const PreparedStream& stream, const InputMap& map, Index row,
                     Real* out) const = 0;
  /// The same for rows that come one by one, after learn().
  virtual std::unique_ptr<StreamingInput> streaming(const InputMap& map) const = 0;
  /// What make_input() makes it from, statistics included.
  virtual Json to_json() const = 0;
};

/// The stream itself, row-major, with the beginnings of its segments.
PreparedStream prepare_rows(const Stream& stream);

/// What a configuration asks for, for these features. Another kind is Error(kUsage).
///   {"kind": "map"}                  (F, 5, 1): Eq. 7 of the row
///   {"kind": "window", "length": T}  (T, F): the last T rows standardised, the segment's first row
///                                    repeated before it
///   {"kind": "body"}                 (F, 5, 1): per-sample columns of channels in the sensor frame
///   {"kind": "lines"}                (F, 7, 1): causal line fits to them (sensor_columns.h)
std::unique_ptr<NetworkInput> make_input(const Json& json, const FeatureLayout& layout,
                                         const std::string& where);
/// From to_json(), for that number of features: Error(kModel).
std::unique_ptr<NetworkInput> stored_input(const Json& json, Index features,
                                           const std::string& where);

}  // namespace dcnn
