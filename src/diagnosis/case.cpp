#include "diagnosis/case.h"

namespace dcnn {

Eigen::MatrixXd measured_part(const Case& study, const Wrench& wrench) {
  Eigen::MatrixXd part(wrench.force.rows(), study.channel_count());
  for (Index j = 0; j < study.channel_count(); ++j) {
    const int channel = study.channels[static_cast<std::size_t>(j)];
    part.col(j) = channel < 3 ? wrench.force.col(channel) : wrench.torque.col(channel - 3);
  }
  return part;
}

void set_derivative(Case& study, const DerivativeSpec& derivative) {
  study.derivative = derivative;
  for (Log& log : study.logs) {
    log.motion = motion_of(log.recording, study.simulator.model, derivative);
  }
}

}  // namespace dcnn
