// SPDX-License-Identifier: Apache-2.0
// Limits from recordings, and the next motion within them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dcnn/design/design.h"
#include "dcnn/physics/motion.h"

namespace dcnn::design {
namespace {

/// The length of the vectors below which all but one in a thousand lie: the noise of derivatives
/// has tails.
double usual_most(const Eigen::MatrixXd& vectors) {
  constexpr double kShare = 0.999;
  Eigen::VectorXd length = vectors.rowwise().norm();
  const auto at = static_cast<Index>(kShare * static_cast<double>(length.size() - 1));
  std::nth_element(length.begin(), length.begin() + at, length.end());
  return length(at);
}

}  // namespace

std::optional<Limits> driven_limits(const std::vector<Recording>& recordings,
                                    const ToolModel& model) {
  constexpr double kLeast = 1e-6;  // of any limit: a motion at rest gives no room
  Eigen::VectorXd low, high;
  PoseLimits pose;
  pose.speed = pose.acceleration = pose.rate = pose.angular_acceleration = kLeast;
  pose.jerk = pose.angular_jerk = std::numeric_limits<double>::infinity();
  pose.radius = {0.0, std::numeric_limits<double>::infinity()};
  for (const Recording& recording : recordings) {
    const Motion m = motion_of(recording, model, DerivativeSpec());
    if (m.is_static() || m.p_B.rows() == 0 || m.v_B.rows() == 0 || m.a_B.rows() == 0) continue;
    Eigen::MatrixXd coordinates(m.samples(), 6);
    coordinates << m.p_B, m.euler;
    const Eigen::VectorXd least = coordinates.colwise().minCoeff(),
                          most = coordinates.colwise().maxCoeff();
    low = low.size() == 0 ? least : Eigen::VectorXd(low.cwiseMin(least));
    high = high.size() == 0 ? most : Eigen::VectorXd(high.cwiseMax(most));
    pose.speed = std::max(pose.speed, usual_most(m.v_B));
    pose.acceleration = std::max(pose.acceleration, usual_most(m.a_B));
    pose.rate = std::max(pose.rate, usual_most(m.w_S));
    pose.angular_acceleration = std::max(pose.angular_acceleration, usual_most(m.dw_S));
  }
  if (low.size() == 0) return std::nullopt;
  constexpr double kSteepestDriven = 1.4;  // rad, |beta|
  Limits limits;
  limits.start = 0.5 * (low + high);
  for (Index k = 0; k < 6; ++k) {
    const double half = 0.5 * (high - low).segment(k < 3 ? 0 : 3, 3).maxCoeff();
    Range range{limits.start(k) - half, limits.start(k) + half};
    if (k == 4) {
      limits.start(k) = std::clamp(limits.start(k), -kSteepestDriven, kSteepestDriven);
      range = {std::max(range.low, -kSteepestDriven), std::min(range.high, kSteepestDriven)};
      range = {std::min(range.low, limits.start(k)), std::max(range.high, limits.start(k))};
    }
    pose.range[static_cast<std::size_t>(k)] = range;
  }
  limits.pose = pose;
  limits.rate_hz = model.sample_rate_hz;
  return limits;
}

Json next_motion(const DiagnosisRequest& request, const Diagnosis& diagnosis) {
  constexpr double kSeconds = 30.0;
  constexpr int kEvaluations = 60;  // half a second
  if (!request.simulator || request.system) return nullptr;
  ReadOptions read = request.read;
  read.static_list = true;  // as the diagnosis reads it
  const Recording first = read_recording(request.fit.front(), read, System());
  try {
    const auto limits = driven_limits({first}, diagnosis.corrected.model);
    if (!limits) return nullptr;
    DesignRequest wanted{
        diagnosis.report, diagnosis.model, "report.json", *limits, kSeconds, kEvaluations, 1};
    Json next = next_motion(make_design(wanted, {}), kSeconds);
    if (!next.is_null()) next["limits"] = to_json(*limits);
    return next;
  } catch (const Error&) {
    return nullptr;  // too short to be differentiated, or an effect needs a signal that no design
                     // has: the rest stands
  }
}

}  // namespace dcnn::design
