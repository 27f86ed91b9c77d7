// SPDX-License-Identifier: Apache-2.0
// Where everything of a reproduction lies under its output folder: cells by their names, plans of
// cells by their stages.
#pragma once

#include <filesystem>
#include <string>

namespace dcnn {

/// The name of a cell is the folder of its files below `out`.
struct OutputLayout {
  std::filesystem::path out;

  /// `series`: a protocol, or one of the further trainings.
  static std::string training(const std::string& series, const std::string& entry) {
    return "models/" + series + "/" + entry;
  }
  static std::string scoring(const std::string& mode, const std::string& series,
                             const std::string& entry) {
    return "scores/" + mode + "/" + series + "/" + entry;
  }
  static std::string timing_of(const std::string& entry) { return "timing/" + entry; }

  std::filesystem::path model(const std::string& series, const std::string& entry) const {
    return out / training(series, entry) / (entry + ".dcnn");
  }
  std::filesystem::path scores(const std::string& mode, const std::string& series,
                               const std::string& entry) const {
    return out / scoring(mode, series, entry) / "evaluation.json";
  }
  std::filesystem::path trace(const std::string& entry) const {
    return out / scoring("feature", "A", entry) / "trace.csv";
  }
  std::filesystem::path timing(const std::string& entry) const {
    return out / timing_of(entry) / "bench.json";
  }
  std::filesystem::path cells(const std::string& stage) const { return out / "cells" / stage; }
  std::filesystem::path report() const { return out / "report.html"; }
};

/// The series of the k-th further training, k from 1, and the mode under which it is scored.
inline std::string further_training(int k) { return "A-training-" + std::to_string(k); }
inline const std::string kFurtherTrainings = "trainings";

}  // namespace dcnn
