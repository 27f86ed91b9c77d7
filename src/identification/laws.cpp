// SPDX-License-Identifier: Apache-2.0
#include "identification/laws.h"

#include <cmath>
#include <functional>

#include "dcnn/physics/effect.h"
#include "physics/effect_law.h"

namespace dcnn::identification {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

const std::vector<std::string> kLines{"tool_z", "base_x", "base_y", "base_z"};
const std::vector<std::string> kTurnAxes{"w_sensor_x", "w_sensor_y", "w_sensor_z"};

/// The motion with the mounting of the state.
Motion mounted(const WristLog& log, const WristState& state) {
  Motion motion = log.motion;
  const Eigen::Matrix3d R_ES = state.R_SE.transpose();
  for (auto& R : motion.R_BS) R = R * R_ES;
  motion.w_S = motion.w_S * R_ES;
  motion.dw_S = motion.dw_S * R_ES;
  return motion;
}

double speed_deviation(const Motion& motion, const std::string& axis) {
  const bool turns = axis.front() == 'w';
  const MatrixXd& v = turns ? motion.w_S : motion.v_B;
  return std::max(1e-9, std::sqrt(v.rowwise().squaredNorm().mean() / 3.0));
}

/// (n, channels) of a force that a law of the catalogue makes.
MatrixXd of_catalogue(const EffectSpec& spec, const WristLog& log, const WristState& state,
                      Index channels) {
  const Motion motion = mounted(log, state);
  Wrench wrench{MatrixXd::Zero(motion.samples(), 3), MatrixXd(0, 3)};
  apply_effect(spec, motion, ToolModel(), wrench);
  MatrixXd out = MatrixXd::Zero(static_cast<Index>(log.kept.size()), channels);
  out.leftCols(3) = log.thinned(wrench.force);
  return out;
}

MatrixXd friction(const Law& law, const WristLog& log, const WristState& state, Index channels) {
  MatrixXd out(static_cast<Index>(log.kept.size()),
               channels * static_cast<Index>(law.names.size()));
  Index at = 0;
  for (const std::string& name : law.names) {
    EffectSpec spec;
    spec.axis = law.axis;
    spec.effect = name == "fc_n" ? "coulomb_friction" : "viscous_friction";
    spec.parameters =
        name == "fc_n"
            ? Json{{"fc_n", 1.0}, {"v0_mps", law.turning * speed_deviation(log.motion, law.axis)}}
            : Json{{"c_nspm", 1.0}};
    out.middleCols(at, channels) = of_catalogue(spec, log, state, channels);
    at += channels;
  }
  return out;
}

/// m R_BE^T (e x g) for a base turned about its x or y axis.
MatrixXd tilt(const WristLog& log, const WristState& state, Index channels) {
  const Vector3d g = ToolModel().gravity;
  MatrixXd raw = MatrixXd::Zero(log.motion.samples(), 2 * channels);
  for (Index k = 0; k < raw.rows(); ++k) {
    const auto& R = log.motion.R_BS[static_cast<std::size_t>(k)];
    for (Index axis = 0; axis < 2; ++axis) {
      const Vector3d turned = R.transpose() * Vector3d::Unit(axis).cross(g);
      raw.row(k).segment(channels * axis, 3) = (state.mass * state.R_SE * turned).transpose();
      if (channels < 6) continue;
      raw.row(k).segment(channels * axis + 3, 3) = (state.R_SE * state.h.cross(turned)).transpose();
    }
  }
  return log.thinned(raw);
}

/// A symmetric matrix on the force; its skew part is a turn of the mounting, its trace the mass.
MatrixXd sensor_matrix(const Law& law, const WristColumns& columns, const WristState& state) {
  const Index channels = columns.y.cols(), n = columns.rows();
  WristState tool = state;  // what acts beside it is not known in this order of laws
  tool.amplitudes.resize(0);
  const MatrixXd F = predicted(columns, tool).leftCols(3).rowwise() - state.bias.transpose();
  MatrixXd out = MatrixXd::Zero(n, channels * static_cast<Index>(law.names.size()));
  if (law.effect == "gain") {
    out.col(0) = F.col(0), out.col(1) = -F.col(1);
    out.col(channels + 1) = F.col(1), out.col(channels + 2) = -F.col(2);
    return out;
  }
  const std::pair<Index, Index> pairs[] = {{0, 1}, {0, 2}, {1, 2}};
  for (Index p = 0; p < 3; ++p) {
    const auto [i, j] = pairs[p];
    out.col(channels * p + i) = F.col(j);
    out.col(channels * p + j) = F.col(i);
  }
  return out;
}

/// -dF/dt, of what is measured: its noise and that noise's derivative are not correlated.
MatrixXd delayed(const WristLog& log, Index channels) {
  MatrixXd rate = MatrixXd::Zero(log.measured.rows(), channels);
  if (log.at_rest) return log.thinned(rate);
  for (const Segment& s : log.motion.segments) {
    for (Index k = s.begin + 1; k + 1 < s.end; ++k) {
      rate.row(k) = (log.measured.row(k - 1) - log.measured.row(k + 1)) / (2.0 * log.recording.dt);
    }
  }
  return log.thinned(rate);
}

/// Of "beta:sensor_x" that of beta over all logs: a cable at rest in the middle of a motion adds to
/// no offset, which else would be as large as the motion is far from zero.
double mean_angle(const std::vector<WristLog>& logs, const std::string& axis) {
  const Index angle = angle_axis(axis).angle;
  double sum = 0.0, rows = 0.0;
  for (const WristLog& log : logs) {
    sum += log.motion.euler.col(angle).sum();
    rows += static_cast<double>(log.motion.euler.rows());
  }
  return sum / std::max(1.0, rows);
}

/// One column for each channel: `signal` in it.
MatrixXd in_each_channel(const VectorXd& signal, Index channels) {
  MatrixXd out = MatrixXd::Zero(signal.size(), channels * channels);
  for (Index c = 0; c < channels; ++c) out.col(channels * c + c) = signal;
  return out;
}

std::vector<std::string> channel_names(const std::string& stem, const std::string& per,
                                       bool torque) {
  std::vector<std::string> names;
  for (const char* axis : {"x", "y", "z"}) names.push_back(stem + axis + "_n" + per);
  if (!torque) return names;
  for (const char* axis : {"tx", "ty", "tz"}) names.push_back(stem + axis + "_nm" + per);
  return names;
}

std::vector<std::string> units_of(const std::vector<std::string>& names, const std::string& per) {
  std::vector<std::string> units;
  for (const std::string& name : names) {
    units.push_back((name.find("_nm") == std::string::npos ? "N" : "N*m") + per);
  }
  return units;
}

void add_friction(const std::string& axis, std::vector<Law>& laws) {
  const bool turns = axis.front() == 'w';
  const std::string per = turns ? "N*s/rad" : "N*s/m";
  laws.push_back({"friction", axis, {"c_nspm"}, {per}, true});
  laws.push_back({"friction", axis, {"fc_n"}, {"N"}, true});
  laws.push_back({"friction", axis, {"fc_n", "c_nspm"}, {"N", per}, true});
}

void add_of_motion(const std::vector<WristLog>& logs, std::vector<Law>& laws) {
  const auto positioned = [](const WristLog& log) { return log.motion.v_B.rows() > 0; };
  if (std::all_of(logs.begin(), logs.end(), positioned)) {
    for (const auto& axis : kLines) add_friction(axis, laws);
    // Less inertia than weight: a filtered reading, or a pose that shakes where the tool does not.
    laws.push_back({"weightless_mass", "", {"mass_kg"}, {"kg"}});
  }
  for (const auto& axis : kTurnAxes) add_friction(axis, laws);
  laws.push_back({"time_delay", "", {"delay_s"}, {"s"}});
}

}  // namespace

std::vector<Law> candidate_laws(const std::vector<WristLog>& logs, bool torque) {
  std::vector<Law> laws;
  const auto moving = [](const WristLog& log) { return !log.at_rest; };
  const auto timed = [](const WristLog& log) { return log.t.size() > 1 && log.t[1] != log.t[0]; };
  if (std::all_of(logs.begin(), logs.end(), moving)) add_of_motion(logs, laws);
  if (std::all_of(logs.begin(), logs.end(), timed)) {
    const auto names = channel_names("rate_", "ps", torque);
    laws.push_back({"linear_drift", "", names, units_of(names, "/s")});
  }
  if (logs.size() > 1) {
    for (std::size_t k = 1; k < logs.size(); ++k) {
      const auto names = channel_names("delta_bias_", "", torque);
      laws.push_back({"bias", logs[k].recording.name, names, units_of(names, "")});
    }
  }
  laws.push_back({"gravity_tilt", "", {"tilt_x_rad", "tilt_y_rad"}, {"rad", "rad"}});
  laws.push_back({"crosstalk", "", {"c_xy", "c_xz", "c_yz"}, {"", "", ""}});
  laws.push_back({"gain", "", {"gain_x_over_y", "gain_y_over_z"}, {"", ""}});
  for (const char* angle : {"alpha", "beta", "gamma"}) {
    for (const char* axis : {"sensor_x", "sensor_y", "sensor_z"}) {
      laws.push_back({"cable_spring", std::string(angle) + ":" + axis, {"k_nprad"}, {"N/rad"}});
    }
  }
  return laws;
}

MatrixXd law_columns(const Law& law, const std::vector<WristLog>& logs, std::size_t k,
                     const WristColumns& columns, const WristState& state) {
  const WristLog& log = logs[k];
  const Index channels = columns.y.cols();
  if (law.effect == "friction") return friction(law, log, state, channels);
  if (law.effect == "gravity_tilt") return tilt(log, state, channels);
  if (law.effect == "time_delay") return delayed(log, channels);
  if (law.effect == "linear_drift") {
    double begin = INFINITY;
    for (const WristLog& other : logs) begin = std::min(begin, other.t[0]);
    return in_each_channel(log.thinned(log.t.array() - begin).col(0), channels);
  }
  if (law.effect == "bias") {
    const double here = log.recording.name == law.axis ? 1.0 : 0.0;
    return in_each_channel(VectorXd::Constant(columns.rows(), here), channels);
  }
  if (law.effect == "weightless_mass") {
    EffectSpec spec;
    spec.effect = law.effect;
    spec.parameters = Json{{"mass_kg", 1.0}};
    return of_catalogue(spec, log, state, channels);
  }
  if (law.effect == "cable_spring") {
    EffectSpec spec;
    spec.effect = law.effect;
    spec.axis = law.axis;
    spec.parameters = Json{{"k_nprad", 1.0}, {"rest_rad", mean_angle(logs, law.axis)}};
    return of_catalogue(spec, log, state, channels);
  }
  return sensor_matrix(law, columns, state);
}

}  // namespace dcnn::identification
