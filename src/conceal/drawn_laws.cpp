// SPDX-License-Identifier: Apache-2.0
// Laws that no catalogue has, with numbers, directions and places drawn: what a discovery is judged
// by. Written in the terms of machines, not of any search.
#include <algorithm>
#include <cmath>

#include "conceal/draws.h"
#include "conceal/laws.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

Vector3d three_of(const Parameters& p, const std::string& stem) {
  return {p.at(stem + "_x"), p.at(stem + "_y"), p.at(stem + "_z")};
}

void draw_three(Parameters& p, Rng& rng, const std::string& stem, double size) {
  for (const char* a : {"_x", "_y", "_z"}) p[stem + a] = size * rng.normal();
}

/// One sample of a path with the states that a law carries from one to the next.
struct Now {
  const Path& path;
  const Parameters& p;
  Index i;
  double* state;  // 8 numbers, zero at the beginning
  const Eigen::RowVector3d field;

  double at(const char* name) const { return p.at(name); }
  const Eigen::Matrix3d& R() const { return path.rotation[static_cast<std::size_t>(i)]; }
  Vector3d position() const { return path.pose.row(i).head<3>(); }
  Vector3d velocity() const { return path.velocity.row(i); }
  double angle() const { return path.pose(i, 3 + which("angle")); }
  Index which(const char* name) const { return static_cast<Index>(p.at(name)); }
  /// Direction 0-2 of the sensor, 3-5 of the base.
  Vector3d n() const {
    const Index k = which("way");
    return k < 3 ? Vector3d(Vector3d::Unit(k)) : Vector3d(R().row(k - 3).transpose());
  }
  double v() const { return (R() * n()).dot(velocity()); }
  Vector3d to_sensor(const Vector3d& f_B) const { return R().transpose() * f_B; }
};

Vector3d fractional_drag(const Now& x) {
  const double v = x.v();
  return x.n() * -std::copysign(elementary::pow(std::abs(v) / 0.1, x.at("exponent")), v);
}
Vector3d eddy_brake(const Now& x) {
  const double u = x.v() / x.at("critical");
  return x.n() * (-2.0 * u / (1.0 + u * u));
}
Vector3d shear_thinning(const Now& x) {  // sinh^-1, Eyring 1936
  const double u = x.v() / x.at("critical");
  return x.n() * -std::copysign(elementary::log(std::abs(u) + std::sqrt(1.0 + u * u)), u);
}
Vector3d check_valve(const Now& x) {  // a damper that is harder one way
  const double v = x.v() / 0.1;
  return x.n() * -(v > 0.0 ? v : x.at("ratio") * v);
}
Vector3d rubber_stop(const Now& x) {
  const Index axis = x.which("side");
  const double depth = std::max(0.0, x.position()[axis] - x.at("edge"));
  Vector3d f = Vector3d::Zero();
  f[axis] = -elementary::pow(depth / 0.05, 1.5);  // Hertz
  return x.to_sensor(f);
}
Vector3d magnet(const Now& x) {
  const Vector3d d = three_of(x.p, "magnet") - x.position();
  return x.to_sensor(d.normalized() * elementary::pow(0.15 / d.norm(), 4));
}
Vector3d coil(const Now& x) {
  return x.to_sensor(x.velocity().cross(three_of(x.p, "field"))) / 0.1;
}
Vector3d hose(const Now& x) {  // a spring with a stiffness of its own in every direction
  const Vector3d d = x.position() - three_of(x.p, "rest");
  const Vector3d e = three_of(x.p, "hose").normalized();
  return x.to_sensor(-10.0 * (0.3 * d + e * e.dot(d)));
}
Vector3d bellows(const Now& x) {  // dry friction whose normal force is a wave of the angle
  return x.n() * (-elementary::tanh(x.v() / 0.01) *
                  (1.0 + 0.6 * elementary::sin(2.0 * x.angle() + x.at("phase"))));
}
Vector3d warm_grease(const Now& x) {
  const double power = x.velocity().squaredNorm();
  x.state[0] += kStep / x.at("seconds") * (power / 0.02 - x.state[0]);
  return x.n() * (-x.v() / 0.1 / (1.0 + x.state[0]));
}
Vector3d plays(const Now& x) {  // Prandtl and Ishlinskii
  const double q = x.angle();
  double f = 0.0;
  for (int k = 0; k < 4; ++k) {
    const double width = x.at("width") * (k + 1);
    if (x.i == 0) x.state[k] = q;
    x.state[k] = std::clamp(x.state[k], q - width, q + width);
    f += q - x.state[k];
  }
  return x.n() * -f;
}
Vector3d rubber_foot(const Now& x) {  // a part of the load comes late
  for (Index c = 0; c < 3; ++c) {
    double& s = x.state[c];
    s = x.i == 0 ? x.field(c) : s + kStep / x.at("seconds") * (x.field(c) - s);
  }
  return {x.state[0], x.state[1], x.state[2]};
}
Vector3d flywheel(const Now& x) {  // a rotor about an axis of the sensor
  return Vector3d(x.path.rate.row(x.i)).cross(Vector3d::Unit(x.which("rotor")));
}
Vector3d tilt_friction(const Now& x) {
  return x.n() * (-elementary::tanh(x.v() / 0.01) * x.field.norm() / 9.81);
}
Vector3d ageing(const Now& x) {  // rate and state: Dieterich 1979
  const double v = x.v(), length = x.at("length");
  x.state[0] += kStep * (1.0 - std::abs(v) * x.state[0] / length);
  x.state[0] = std::clamp(x.state[0], 0.0, 1e3);
  return x.n() * (-elementary::tanh(v / 0.005) * (1.0 + elementary::log1p(x.state[0] / 0.05)));
}

struct DrawnLaw {
  const char* id;
  Vector3d (*force)(const Now&);
};
const std::vector<DrawnLaw>& laws() {
  static const std::vector<DrawnLaw> list{{"fractional_drag", fractional_drag},
                                          {"eddy_brake", eddy_brake},
                                          {"shear_thinning", shear_thinning},
                                          {"check_valve", check_valve},
                                          {"rubber_stop", rubber_stop},
                                          {"magnet", magnet},
                                          {"coil", coil},
                                          {"hose", hose},
                                          {"bellows", bellows},
                                          {"warm_grease", warm_grease},
                                          {"plays", plays},
                                          {"rubber_foot", rubber_foot},
                                          {"flywheel", flywheel},
                                          {"tilt_friction", tilt_friction},
                                          {"ageing", ageing}};
  return list;
}

}  // namespace

const std::vector<std::string>& drawn_laws() {
  static const std::vector<std::string> ids = [] {
    std::vector<std::string> names;
    for (const DrawnLaw& law : laws()) names.emplace_back(law.id);
    return names;
  }();
  return ids;
}

bool is_drawn_law(const std::string& id) {
  const auto& ids = drawn_laws();
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

std::map<std::string, double> draw_law(Rng& rng) {
  Parameters p{{"size", 0.3},
               {"way", static_cast<double>(rng.below(6))},
               {"angle", static_cast<double>(rng.below(3))},
               {"side", static_cast<double>(rng.below(3))},
               {"rotor", static_cast<double>(rng.below(3))},
               {"exponent", rng.uniform(0.4, 2.6)},
               {"critical", logarithmic(rng, 0.01, 0.08)},
               {"ratio", rng.uniform(-0.2, 0.6)},
               {"phase", rng.uniform(-3.0, 3.0)},
               {"seconds", logarithmic(rng, 0.3, 8.0)},
               {"width", logarithmic(rng, 0.02, 0.1)},
               {"length", logarithmic(rng, 0.0005, 0.01)}};
  draw_three(p, rng, "field", 1.0);
  draw_three(p, rng, "hose", 1.0);
  draw_three(p, rng, "rest", 0.1);
  draw_three(p, rng, "magnet", 0.15);
  p["edge"] = rng.uniform(-0.05, 0.05);
  // The motions are about a place 0.5 m in front of the base.
  for (const char* stem : {"rest", "magnet"}) p[stem + std::string("_x")] += 0.5;
  p["edge"] += p["side"] == 0.0 ? 0.5 : 0.0;
  return p;
}

void add_drawn_law(const Path& path, const Hidden& h, const MatrixXd& field, MatrixXd& F) {
  const auto law = std::find_if(laws().begin(), laws().end(),
                                [&](const DrawnLaw& l) { return h.effect == l.id; });
  double state[8] = {};
  for (Index i = 0; i < path.samples(); ++i) {
    F.row(i) += h.parameters.at("size") *
                law->force({path, h.parameters, i, state, field.row(i)}).transpose();
  }
}

std::vector<std::string> laws_plan(int count) {
  std::vector<std::string> ids;
  const char* const amplitudes[] = {"1", "3", "10"};
  const std::size_t kinds = drawn_laws().size();
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    ids.push_back(std::string("law:") + amplitudes[(k + k / kinds) % 3] + "/" +
                  drawn_laws()[k % kinds] + "/" + std::to_string(k));
  }
  return ids;
}

}  // namespace dcnn::conceal
