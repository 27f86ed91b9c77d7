// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "conceal/draws.h"

namespace dcnn::conceal {
namespace {

/// The parameters that make an effect strong and leave its shape.
bool is_strength(const Hidden& h, const std::string& name) {
  if (is_drawn_law(h.effect)) return name == "size";
  if (has("thermal_drift creep", h.effect) && name == "tau_s") return false;
  if (h.effect == "gear_friction" && name == "a") return false;
  return !has(
      "lever_x_m lever_y_m lever_z_m v0_mps vs_mps width_rad asym beta gamma m rest_rad order "
      "phase_rad gap_m freq_hz zeta t_ref_degc",
      name);
}

/// Beyond this nobody would call it the same tool.
double largest(const Hidden& h, const Tool& tool, const std::string& name) {
  if (name == "delta_mass_kg") return 0.5 * tool.mass;
  if (name.rfind("delta_com", 0) == 0) return 0.05;
  if (name == "fraction") return 0.9;
  if (name == "mu" || name == "a") return 1.0;
  if (name == "delay_s" || (h.effect == "lowpass" && name == "tau_s")) return 0.08;
  if (name.rfind("tilt", 0) == 0 || name.rfind("rot", 0) == 0) return 0.15;
  if (name.rfind("gain", 0) == 0 || name.rfind("c_", 0) == 0) {
    return h.effect == "gain" || h.effect == "crosstalk" ? 0.2
                                                         : std::numeric_limits<double>::infinity();
  }
  if (name == "slug_kg") return 0.2 * tool.mass;
  return std::numeric_limits<double>::infinity();
}

Hidden scaled(Hidden h, const Tool& tool, double factor) {
  for (const auto& [name, value] : h.parameters) {
    if (is_strength(h, name) && value != 0.0) {
      factor = std::min(factor, largest(h, tool, name) / std::abs(value));
    }
  }
  for (auto& [name, value] : h.parameters) {
    if (is_strength(h, name)) value *= factor;
  }
  return h;
}

/// The simulator's own tool in a world without the effect; the world of inertial_terms is full.
class Contribution {
 public:
  Contribution(const std::vector<Path>& paths, const Scenario& s) : paths_(paths), s_(s) {
    for (std::size_t k = 0; k < paths.size(); ++k) {
      if (!s.recordings[k].holdout)
        plain_.push_back(reading(paths[k], s.tool, {}, {}, s.conditions.samples_per_reading));
    }
  }

  /// rms [N] on the strongest axis; of a torque, as that of the force whose noise is as strong.
  double operator()(const Hidden& h) const {
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(plain_.front().cols());
    double rows = 0.0;
    auto plain = plain_.begin();
    for (std::size_t k = 0; k < paths_.size(); ++k) {
      if (s_.recordings[k].holdout) continue;
      const Eigen::MatrixXd d =
          reading(paths_[k], s_.tool, {h}, {}, s_.conditions.samples_per_reading) - *plain++;
      squares += d.colwise().squaredNorm().transpose();
      rows += static_cast<double>(d.rows());
    }
    if (squares.size() > 3) squares.tail(3) /= s_.conditions.torque_m * s_.conditions.torque_m;
    return std::sqrt(squares.maxCoeff() / rows);
  }

 private:
  const std::vector<Path>& paths_;
  const Scenario& s_;
  std::vector<Eigen::MatrixXd> plain_;
};

/// A loose load that does not slide to and fro is no more than a part of the tool.
bool slides(const std::vector<Path>& paths, const Scenario& s, const Hidden& h) {
  constexpr double kTurned = 0.5;  // m/s^2
  constexpr int kFewest = 6;       // ways from stop to stop
  int turns = 0;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    if (s.recordings[k].holdout) continue;
    const Eigen::VectorXd field = felt_field(paths[k]).col(h.axis.back() - 'x');
    double side = 0.0;
    for (Eigen::Index i = 0; i < field.size(); ++i) {
      if (std::abs(field(i)) < kTurned || side * field(i) > 0.0) continue;
      if (side != 0.0) ++turns;
      side = field(i);
    }
  }
  return turns >= kFewest;
}

/// A clip acts from its limit down.
Hidden clipped(const Contribution& contribution, Hidden h, double target) {
  double low = 0.0, high = 60.0;
  for (int k = 0; k < 30; ++k) {
    h.parameters["limit_n"] = 0.5 * (low + high);
    (contribution(h) > target ? low : high) = h.parameters["limit_n"];
  }
  h.parameters["limit_n"] = high;
  return h;
}

}  // namespace

std::optional<Hidden> of_amplitude(const std::vector<Path>& paths, const Scenario& s, Hidden h,
                                   double target) {
  constexpr double kNothing = 1e-6;  // N, of parameters as drawn: below it there is rounding alone
  if (h.effect == "loose_load" && !slides(paths, s, h)) return std::nullopt;
  const Contribution contribution(paths, s);
  if (h.effect == "saturation") h = clipped(contribution, h, target);
  double now = contribution(h);
  if (now < kNothing) return std::nullopt;
  if (h.effect != "saturation" && h.effect != "inertial_terms") {
    // Secant steps through the origin: exact at once for what is linear.
    for (int k = 0; k < 4 && std::abs(now / target - 1.0) > 0.01; ++k) {
      h = scaled(h, s.tool, target / now);
      now = contribution(h);
    }
  }
  h.amplitude = now / s.noise.sigma;
  return h;
}

}  // namespace dcnn::conceal
