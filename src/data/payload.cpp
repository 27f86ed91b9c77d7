// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/recording.h"
#include "dcnn/data/rotation.h"

namespace dcnn {

void add_weight(const Payload& payload, Recording& recording) {
  constexpr double kGravity = 9.80665;  // m/s², the standard value that controllers use
  const Eigen::Matrix3d R_ES = rotation_from_euler(payload.rpy.reverse());
  const std::vector<Eigen::Matrix3d> R_BE = rotations(recording);
  Eigen::MatrixXd force(recording.samples(), 3);
  for (Index i = 0; i < force.rows(); ++i) {
    const Eigen::Matrix3d R_BS = R_BE[static_cast<std::size_t>(i)] * R_ES;
    force.row(i) = -payload.mass * kGravity * R_BS.row(2);
  }
  const auto add = [&](const std::vector<std::string>& names, const Eigen::MatrixXd& more) {
    for (Index k = 0; k < 3; ++k) {
      const std::string& name = names[static_cast<std::size_t>(k)];
      if (recording.has(name)) recording.set(name, recording.column(name) + more.col(k));
    }
  };
  add({"fx", "fy", "fz"}, force);
  add({"tx", "ty", "tz"}, force * cross_matrix(payload.com).transpose());
  std::ostringstream note;
  note << "the weight of a payload of " << payload.mass << " kg added back";
  recording.notes.push_back(note.str());
}

}  // namespace dcnn
