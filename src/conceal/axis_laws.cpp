// SPDX-License-Identifier: Apache-2.0
// Laws of drives that no catalogue has, written in the terms of machines. Forces have unit size;
// what a sensor or a belt makes of the effort is a share `size` of the whole change.
#include <algorithm>
#include <cmath>

#include "conceal/axis_world.h"
#include "core/elementary.h"
#include "dcnn/conceal/axis.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Numbers = std::map<std::string, double>;
constexpr double kHalfTurn = 3.141592653589793;

/// One sample of a path with the states that a law carries from one to the next.
struct AxisNow {
  const Numbers& p;
  double q, v, rigid, step;
  double* state;  // 4 numbers, zero at the first sample
  bool first, still;

  double at(const char* name) const { return p.at(name); }
  double sign() const { return elementary::tanh(v / at("v0")); }
  double speed() const { return v / at("speed"); }
  double place() const { return (q - at("place")) / at("width"); }
};

/// Friction that the heat of its own work thins: dT/dt = (power - T)/τ, f = sign(v)/(1 + 2T).
double warm_friction(const AxisNow& x) {
  const double u = std::abs(x.v) / x.at("fast");
  x.state[0] += x.step / x.at("seconds") * (3.0 * u - x.state[0]);
  return x.sign() / (1.0 + 2.0 * x.state[0]);
}
/// A stop that is met gradually: exp of the way to the end of the range.
double hard_stop(const AxisNow& x) {
  return elementary::exp(std::min(20.0, x.at("side") * (x.q - x.at("end")) / x.at("width")));
}
/// Friction that varies with the position and grows by up to its own while the axis rests.
double wavy_dwell(const AxisNow& x) {
  if (x.still) {
    x.state[0] += x.step / x.at("seconds") * (1.0 - x.state[0]);
  } else {
    x.state[0] -= std::min(1.0, std::abs(x.v) * x.step / x.at("width")) * x.state[0];
  }
  return x.sign() * (1.0 + x.state[0] + 0.7 * elementary::sin(x.at("order") * x.q + x.at("phase")));
}
double fractional_drag_of_axis(const AxisNow& x) {
  return std::copysign(elementary::pow(std::abs(x.v) / x.at("fast"), 1.5), x.v);
}
/// Rate and state (Dieterich 1979): dθ/dt = 1 - |v| θ/L, f = sign(v)(1 + ln(1 + θ/θ0)/2).
double ageing_of_axis(const AxisNow& x) {
  const double length = x.at("width");
  x.state[0] =
      std::clamp(x.state[0] + x.step * (1.0 - std::abs(x.v) * x.state[0] / length), 0.0, 1e3);
  return x.sign() * (1.0 + 0.5 * elementary::log1p(x.state[0] / (0.1 * x.at("seconds"))));
}
/// A magnet at one place: the slope of a Gaussian well.
double detent(const AxisNow& x) {
  const double u = x.place();
  return u * elementary::exp(0.5 * (1.0 - u * u));
}
double eddy_brake_of_axis(const AxisNow& x) {
  const double u = x.speed();
  return 2.0 * u / (1.0 + u * u);
}
/// sinh^-1 (Eyring 1936).
double shear_thinning_of_axis(const AxisNow& x) {
  const double u = x.speed();
  return std::copysign(elementary::log(std::abs(u) + std::sqrt(1.0 + u * u)), u);
}
/// A spring that is stiffer while the axis moves one way.
double one_way_spring(const AxisNow& x) {
  return (x.q - x.at("middle")) / x.at("wide") * (1.0 + x.at("share") * x.sign());
}
/// A spring with play: nothing within the gap, a line beyond it.
double slack_spring(const AxisNow& x) {
  const double d = (x.q - x.at("middle")) / x.at("wide");
  return std::copysign(std::max(0.0, std::abs(d) - 0.4), d) / 0.6;
}
/// Spring and dashpot in series: dx/dt = v - x/τ.
double maxwell_element(const AxisNow& x) {
  x.state[0] += x.step * (x.v - x.state[0] / x.at("seconds"));
  return x.state[0] / x.at("wide");
}
/// Friction of the square root of what is transmitted.
double root_load_friction(const AxisNow& x) {
  return std::sqrt(std::abs(x.rigid) / x.at("effort")) * x.sign();
}
/// A ripple of the position as strong as what is transmitted.
double load_ripple(const AxisNow& x) {
  return x.rigid / x.at("effort") * elementary::sin(x.at("order") * x.q + x.at("phase"));
}

struct AxisLaw {
  const char* id;
  const char* kind;
  double (*force)(const AxisNow&);  ///< null: it changes the reading
};
const std::vector<AxisLaw>& axis_law_list() {
  static const std::vector<AxisLaw> list{{"warm_friction", "friction", warm_friction},
                                         {"hard_stop", "spring", hard_stop},
                                         {"wavy_dwell", "friction", wavy_dwell},
                                         {"axis_drag", "friction", fractional_drag_of_axis},
                                         {"axis_ageing", "friction", ageing_of_axis},
                                         {"detent", "ripple", detent},
                                         {"axis_eddy_brake", "friction", eddy_brake_of_axis},
                                         {"axis_thinning", "friction", shear_thinning_of_axis},
                                         {"one_way_spring", "spring", one_way_spring},
                                         {"slack_spring", "spring", slack_spring},
                                         {"maxwell_element", "spring", maxwell_element},
                                         {"root_load_friction", "friction", root_load_friction},
                                         {"load_ripple", "ripple", load_ripple},
                                         {"gain_saturation", "scale", nullptr},
                                         {"belt_slip", "scale", nullptr},
                                         {"speed_delay", "lag", nullptr},
                                         {"slew_limit", "lag", nullptr}};
  return list;
}
const AxisLaw* find_axis_law(const std::string& id) {
  for (const AxisLaw& law : axis_law_list()) {
    if (id == law.id) return &law;
  }
  return nullptr;
}

/// y = F/(1 + (F/F0)²): a current sensor whose core saturates.
VectorXd saturating(const VectorXd& F, double knee) {
  return F.array() / (1.0 + (F.array() / knee).square());
}
/// Beyond its grip a belt transmits a third of what is added.
VectorXd slipping(const VectorXd& F, double grip) {
  return F.unaryExpr([=](double f) {
    return std::abs(f) <= grip ? f : std::copysign(grip + (std::abs(f) - grip) / 3.0, f);
  });
}
/// F(t - d |v|/fast).
VectorXd late_with_speed(const AxisPath& path, const VectorXd& F, double most, double fast) {
  VectorXd y(F.size());
  for (Index i = 0; i < F.size(); ++i) {
    const double late = most * std::min(3.0, std::abs(path.v(i)) / fast) / path.step;
    const double at = std::max(0.0, static_cast<double>(i) - late);
    const Index k = std::min(static_cast<Index>(at), F.size() - 2);
    y(i) = F(k) + (at - static_cast<double>(k)) * (F(k + 1) - F(k));
  }
  return y;
}
/// A reading that follows by `rate` a second at most.
VectorXd slewed(const AxisPath& path, const VectorXd& F, double rate) {
  VectorXd y = F;
  for (Index i = 1; i < F.size(); ++i) {
    y(i) = y(i - 1) + std::clamp(F(i) - y(i - 1), -rate * path.step, rate * path.step);
  }
  return y;
}

void change_by_law(const AxisPath& path, const Hidden& h, VectorXd& F) {
  const Numbers& p = h.parameters;
  const double size = p.at("size");
  VectorXd all = F;
  if (h.effect == "gain_saturation") all = saturating(F, 3.0 * p.at("effort"));
  if (h.effect == "belt_slip") all = slipping(F, p.at("grip") * p.at("effort"));
  if (h.effect == "speed_delay") {
    F = late_with_speed(path, F, size * p.at("late"), p.at("fast"));
    return;
  }
  if (h.effect == "slew_limit") all = slewed(path, F, p.at("slew") * p.at("effort"));
  F += std::min(1.0, size) * (all - F);
}

}  // namespace

const std::vector<std::string>& axis_laws() {
  static const std::vector<std::string> ids = [] {
    std::vector<std::string> names;
    for (const AxisLaw& law : axis_law_list()) names.emplace_back(law.id);
    return names;
  }();
  return ids;
}

bool is_axis_law(const std::string& id) { return find_axis_law(id) != nullptr; }
std::string class_of_axis_law(const std::string& id) { return find_axis_law(id)->kind; }

std::map<std::string, double> draw_axis_law(const std::string& id, const AxisBody& b, Rng& rng) {
  const double side = rng.uniform() < 0.5 ? -1.0 : 1.0;
  Numbers p{{"size", has("gain_saturation belt_slip speed_delay slew_limit", id) ? 0.2 : b.effort},
            {"v0", b.fast * logarithmic(rng, 0.01, 0.05)},
            {"fast", b.fast},
            {"speed", b.fast * logarithmic(rng, 0.1, 0.6)},
            {"seconds", logarithmic(rng, 0.3, 8.0)},
            {"middle", b.middle},
            {"wide", b.wide},
            {"side", side},
            {"end", b.middle + side * b.wide * rng.uniform(0.6, 0.9)},
            {"place", b.middle + b.wide * rng.uniform(-0.6, 0.6)},
            {"width", b.wide * logarithmic(rng, 0.05, 0.2)},
            {"order", rng.uniform(2.0, 8.0) * kHalfTurn / b.wide},
            {"phase", rng.uniform(-3.0, 3.0)},
            {"share", rng.uniform(0.4, 0.9)},
            {"effort", b.effort},
            {"grip", rng.uniform(1.0, 1.6)},
            {"late", 0.03 / b.hz},
            {"slew", b.hz * logarithmic(rng, 4.0, 8.0)}};
  return p;
}

void add_axis_law(const AxisBody&, const AxisPath& path, const Hidden& h, const VectorXd& rigid,
                  VectorXd& effort) {
  const AxisLaw& law = *find_axis_law(h.effect);
  if (law.force == nullptr) return change_by_law(path, h, effort);
  double state[4] = {};
  const double size = h.parameters.at("size"), still = 1e-4 * h.parameters.at("fast");
  for (Index i = 0; i < effort.size(); ++i) {
    effort(i) += size * law.force({h.parameters, path.q(i), path.v(i), rigid(i), path.step, state,
                                   i == 0, std::abs(path.v(i)) < still});
  }
}

}  // namespace dcnn::conceal
