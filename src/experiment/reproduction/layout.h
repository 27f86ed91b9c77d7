// Where everything of a reproduction lies under its output folder.
#pragma once

#include <filesystem>
#include <string>

namespace dcnn {

struct OutputLayout {
  std::filesystem::path out;

  std::filesystem::path data() const { return out / "data"; }
  std::filesystem::path stamps() const { return out / "steps"; }
  /// `series`: a protocol, or one of the further trainings.
  std::filesystem::path model(const std::string& series, const std::string& entry) const {
    return out / "models" / series / (entry + ".dcnn");
  }
  std::filesystem::path scores(const std::string& mode, const std::string& series,
                               const std::string& entry) const {
    return out / "scores" / mode / series / (entry + ".json");
  }
  std::filesystem::path trace(const std::string& entry) const {
    return out / "traces" / (entry + ".csv");
  }
  std::filesystem::path timing(const std::string& entry) const {
    return out / "timing" / (entry + ".json");
  }
  std::filesystem::path report() const { return out / "report.html"; }
};

/// The series of the k-th further training, k from 1, and the mode under which it is scored.
inline std::string further_training(int k) { return "A-training-" + std::to_string(k); }
inline const std::string kFurtherTrainings = "trainings";

}  // namespace dcnn
