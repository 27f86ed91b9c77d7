// SPDX-License-Identifier: Apache-2.0
// What a shallow network reads of a stream.
#pragma once

#include <memory>
#include <vector>

#include "dcnn/models/network_input.h"
#include "models/shallow_network.h"

namespace dcnn {

/// Columns of the features or of any NetworkInput; those that are constant over the training rows
/// are left out, the others mapped to [-1, 1] by their least and greatest training values.
class ShallowInput {
 public:
  /// `model.inputs`: "all", "angles" (the orientation, or the axes' positions: the earlier works,
  /// D26) or a list of feature names; `model.input`: a network input in place of the features.
  ShallowInput(Options& model, const FeatureLayout& layout, const std::string& where);
  /// As save() wrote it, for so many features.
  ShallowInput(const Container& file, Index features, const std::string& where);

  Index count() const { return static_cast<Index>(columns_.size()); }
  /// Error(kData) where no column varies.
  void learn(const Samples& training, const InputMap& map, const NoiseSpec& noise);
  /// (rows.size(), count()), mapped.
  RowMatrix read(const Stream& stream, const InputMap& map, const std::vector<Index>& rows) const;
  void save(Container& file) const;

  /// read() for rows that come one by one, after learn().
  class Streaming {
   public:
    Streaming(const ShallowInput& input, const InputMap& map);
    void reset() noexcept;
    /// Sets the first count() of `signals` at the row x (F). Allocates, locks and throws nothing.
    void push(const Eigen::VectorXd& x, Eigen::RowVectorXd& signals) noexcept;

   private:
    std::unique_ptr<StreamingInput> input_;  // null: the features themselves
    std::vector<Index> columns_;
    Eigen::RowVectorXd least_, scale_;
  };

 private:
  Index available(Index features) const;
  RowMatrix raw(const Stream& stream, const InputMap& map, const std::vector<Index>& rows) const;

  std::unique_ptr<NetworkInput> input_;  // null: the features themselves
  std::vector<Index> columns_;           // in ascending order
  Eigen::RowVectorXd least_, most_;      // of each column
};

/// 0 … n - 1.
std::vector<Index> all_rows(Index n);

}  // namespace dcnn
