// SPDX-License-Identifier: Apache-2.0
// A trained identifier as users hold it: recording in, forces out, one file.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "dcnn/models/model.h"
#include "dcnn/models/online_limits.h"
#include "dcnn/physics/simulator.h"

namespace dcnn {

struct Identifier {
  std::string name;      ///< the model kind
  FeatureLayout layout;  ///< how features are made from a recording
  Targets targets;
  std::unique_ptr<Model> model;
  std::optional<Simulator> base;  ///< the model learned what this simulator leaves (wrist only)
  std::optional<OnlineLimits> online;  ///< of models trained with --online
  Json configuration;                  ///< resolved, for reports
  std::uint64_t seed = 0;

  /// (T, targets) from features of the recording, plus the base simulator's part.
  Eigen::MatrixXd predict(const Recording& recording) const;
  /// Model::novelty() of the recording's rows; empty where the model does not measure it.
  Eigen::VectorXd novelty(const Recording& recording) const;
  /// The base simulator's part alone, zeros without one.
  Eigen::MatrixXd base_prediction(const Recording& recording) const;
};

/// The whole identifier as a model file's content.
Container pack(const Identifier& identifier);
/// Error(kModel) where the container is not a complete identifier of a known kind and format
/// version.
Identifier unpack(const Container& file, const std::string& where);
/// Predicting in this precision: Error(kUsage) where its model cannot.
Identifier read_identifier(const std::filesystem::path& path,
                           Precision precision = Precision::kSingle);

}  // namespace dcnn
