// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/remainder.h"

#include <chrono>
#include <cmath>

#include "dcnn/experiment/train.h"

namespace dcnn {
namespace {

/// Squares of errors per axis over recordings, without their ends.
class Errors {
 public:
  void add(const Recording& recording, const Eigen::MatrixXd& error) {
    const Index ends = std::lround(0.5 / recording.dt), rows = error.rows() - 2 * ends;
    if (rows <= 0) return;
    const Eigen::RowVectorXd squares = error.middleRows(ends, rows).colwise().squaredNorm();
    squares_ = rows_ > 0 ? Eigen::RowVectorXd(squares_ + squares) : squares;
    rows_ += rows;
  }
  Json rmse() const {
    if (rows_ == 0) return nullptr;
    Json list = Json::array();
    for (const double s : squares_) list.push_back(std::sqrt(s / static_cast<double>(rows_)));
    return list;
  }

 private:
  Eigen::RowVectorXd squares_;
  Index rows_ = 0;
};

}  // namespace

Json learn_remainder(const RemainderRequest& request) {
  const auto start = std::chrono::steady_clock::now();
  TrainingRequest training;
  training.configuration.model = request.model;
  training.configuration.preset = request.preset;
  training.training = request.fit;
  training.base = request.simulator;
  training.out = request.out / "model.dcnn";
  train(training, {});
  const Identifier identifier = read_identifier(training.out);
  Errors before, after;
  for (const auto& file : request.holdout) {
    const Recording recording = read_recording(file, ReadOptions(), identifier.layout.system);
    const Eigen::MatrixXd wanted = recording.block(identifier.targets.names);
    before.add(recording, wanted - identifier.base_prediction(recording));
    after.add(recording, wanted - identifier.predict(recording));
  }
  Json report{{"fit_only", true}, {"verdict", "fit only"}, {"findings", Json::array()}};
  report["fit"] = {{"holdout_rmse_before", before.rmse()}, {"holdout_rmse_after", after.rmse()}};
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  report["seconds"] = taken.count();
  return report;
}

}  // namespace dcnn
