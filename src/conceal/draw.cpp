#include <algorithm>
#include <cmath>

#include "conceal/world.h"
#include "dcnn/core/error.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Parameters = std::map<std::string, double>;

std::uint64_t hash_of(const std::string& s) {
  std::uint64_t h = 1469598103934665603ULL;  // FNV-1a
  for (char c : s) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return h;
}

double logarithmic(Rng& rng, double low, double high) {
  return low * std::pow(high / low, rng.uniform());
}

template <class T>
T one_of(Rng& rng, const std::vector<T>& all) {
  return all[rng.below(all.size())];
}

void vector(Parameters& p, Rng& rng, const std::string& before, const std::string& after) {
  for (char a : {'x', 'y', 'z'}) p[before + a + after] = rng.normal();
}

bool has(const std::string& list, const std::string& id) {
  return (" " + list + " ").find(" " + id + " ") != std::string::npos;
}

std::string draw_axis(const std::string& id, Rng& rng) {
  const std::string angle = one_of<std::string>(rng, {"alpha", "beta", "gamma"});
  const std::string sensor = one_of<std::string>(rng, {"sensor_x", "sensor_y", "sensor_z"});
  if (has("cable_spring hysteresis cogging cubic_spring gravity_square", id)) {
    return angle + ":" + sensor;
  }
  if (has("loose_load flexible_resonance saturation two_modes", id)) return sensor;
  if (id.find("friction") == std::string::npos && id != "quadratic_drag" &&
      id != "velocity_position" && id != "drifting_lugre") {
    return "";
  }
  return one_of<std::string>(rng, {"tool_z", "base_x", "base_y", "base_z"});
}

void draw_forces(const std::string& id, Rng& rng, Parameters& p) {
  if (has("coulomb_friction stribeck_friction", id)) {
    p = {{"fc_n", 0.3}, {"v0_mps", logarithmic(rng, 0.002, 0.02)}};
  }
  if (id == "stribeck_friction") {
    p["fs_n"] = 0.3 * rng.uniform(1.6, 3.0);
    p["vs_mps"] = logarithmic(rng, 0.02, 0.06);
  }
  if (id == "viscous_friction") p["c_nspm"] = 1.0;
  if (id == "quadratic_drag") p["c2_ns2pm2"] = 3.0;
  if (has("lugre_friction drifting_lugre", id)) {
    const double fc = 0.3, presliding = logarithmic(rng, 0.0005, 0.005);
    p = {{"fc_n", fc}, {"sigma0_npm", fc / presliding}, {"sigma1_nspm", rng.uniform(0.1, 1.0)}};
  }
  if (id == "hysteresis") {
    p = {{"force_n", 0.2},
         {"width_rad", logarithmic(rng, 0.05, 0.3)},
         {"asym", rng.uniform(0.2, 0.8)}};
  }
  if (id == "cable_spring") p = {{"k_nprad", 0.2}, {"rest_rad", rng.uniform(-0.3, 0.3)}};
  if (id == "cogging") {
    p = {{"amp_n", 0.1},
         {"order", std::floor(rng.uniform(5.0, 24.0))},
         {"phase_rad", rng.uniform(-3.0, 3.0)}};
  }
  if (id == "loose_load") p = {{"slug_kg", 0.03}, {"gap_m", rng.uniform(0.003, 0.012)}};
  if (has("contact event_train", id)) vector(p, rng, "force_", "_n");
  if (p.empty()) p["size"] = 0.3;
}

Parameters draw_parameters(const std::string& id, Rng& rng) {
  Parameters p;
  if (id == "mass")
    p["delta_mass_kg"] = rng.uniform() < 0.5 ? -0.02 : 0.02;
  else if (id == "com")
    vector(p, rng, "delta_com_", "_m");
  else if (id == "gravity_tilt")
    p = {{"tilt_x_rad", rng.normal()}, {"tilt_y_rad", rng.normal()}};
  else if (id == "bias")
    vector(p, rng, "delta_bias_", "_n");
  else if (id == "misalignment")
    vector(p, rng, "rot_", "_rad");
  else if (id == "gain")
    vector(p, rng, "gain_", "");
  else if (id == "crosstalk") {
    for (const char* k : {"c_xy", "c_xz", "c_yx", "c_yz", "c_zx", "c_zy"}) p[k] = rng.normal();
  } else if (id == "time_delay")
    p["delay_s"] = 0.01;
  else if (id == "lowpass")
    p["tau_s"] = 0.01;
  else if (id == "thermal_drift") {
    vector(p, rng, "a_", "_n");
    p["tau_s"] = logarithmic(rng, 10.0, 40.0);
  } else if (id == "linear_drift")
    vector(p, rng, "rate_", "_nps");
  else if (id == "step_bias")
    vector(p, rng, "step_", "_n");
  else if (id == "saturation")
    p["limit_n"] = 5.0;
  else if (id == "quantisation")
    p["step_n"] = 0.1;
  else if (id == "hum") {
    vector(p, rng, "sin_", "_n");
    vector(p, rng, "cos_", "_n");
    p["freq_hz"] = logarithmic(rng, 3.0, 120.0);
  } else if (has("flexible_resonance two_modes", id)) {
    p = {{"freq_hz", logarithmic(rng, 4.0, 15.0)},
         {"zeta", logarithmic(rng, 0.01, 0.1)},
         {"fraction", 0.5}};
  } else
    draw_forces(id, rng, p);
  return p;
}

/// The parameters that make an effect strong and leave its shape.
bool is_strength(const std::string& name) {
  for (const char* shape : {"v0_mps", "vs_mps", "width_rad", "asym", "rest_rad", "order",
                            "phase_rad", "gap_m", "freq_hz", "zeta"}) {
    if (name == shape) return false;
  }
  return true;
}

Hidden scaled(Hidden h, double factor) {
  for (auto& [name, value] : h.parameters) {
    const bool settles = h.effect == "thermal_drift" && name == "tau_s";
    if (is_strength(name) && !settles) value *= factor;
  }
  return h;
}

double contribution(const std::vector<Path>& paths, const std::vector<Eigen::MatrixXd>& plain,
                    const Scenario& s, const Hidden& h) {
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  double rows = 0.0;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    if (s.recordings[k].holdout) continue;
    const Eigen::MatrixXd d = reading(paths[k], s.tool, {h}, {}) - plain[k];
    squares += d.colwise().squaredNorm().transpose();
    rows += static_cast<double>(d.rows());
  }
  return std::sqrt(squares.maxCoeff() / rows);
}

/// Secant steps in the logarithm: exact at once for what is linear. A clip acts from its limit
/// down.
Hidden of_amplitude(const std::vector<Path>& paths, const std::vector<Eigen::MatrixXd>& plain,
                    const Scenario& s, Hidden h, double target) {
  if (h.effect == "saturation") {
    double low = 0.0, high = 4.0;
    for (int k = 0; k < 25; ++k) {
      const double middle = 0.5 * (low + high);
      (contribution(paths, plain, s, scaled(h, middle)) > target ? low : high) = middle;
    }
    return scaled(h, high);
  }
  for (int k = 0; k < 4; ++k) {
    const double now = contribution(paths, plain, s, h);
    require(now > 0.0, Exit::kUsage, s.id, ": the effect changes nothing on this motion");
    if (std::abs(now / target - 1.0) < 0.01) break;
    h = scaled(h, target / now);
  }
  return h;
}

Eigen::MatrixXd sensor_noise(const Noise& noise, Index rows, Rng& rng) {
  Eigen::MatrixXd e(rows, 3);
  for (Index j = 0; j < 3; ++j) {
    double state = rng.normal();
    for (Index i = 0; i < rows; ++i) {
      double x = rng.normal();
      if (noise.kind == "ar1") x = state = 0.8 * state + 0.6 * x;
      if (noise.kind == "heteroscedastic") {
        x *= 1.0 + 0.6 * std::sin(6.28 * static_cast<double>(i) / 6000.0);
      }
      if (noise.kind == "heavy" && rng.uniform() < 0.01) x *= 6.0;
      e(i, j) = noise.sigma * x;
    }
  }
  return e;
}

void record(Scenario& s, const std::vector<Path>& paths, Rng& rng) {
  for (std::size_t k = 0; k < paths.size(); ++k) {
    Recorded& r = s.recordings[k];
    r.clean = reading(paths[k], s.tool, s.hidden, {});
    const Index n = r.clean.rows();
    r.measured = reading(paths[k], s.tool, s.hidden, sensor_noise(s.noise, n, rng));
    if (s.noise.kind == "quantised") r.measured = (r.measured * 2000.0).array().round() / 2000.0;
    r.t.resize(n);
    r.pose.resize(n, 6);
    for (Index i = 0; i < n; ++i) {
      r.t(i) = paths[k].time(i * kDecimation);
      for (Index j = 0; j < 6; ++j) {
        r.pose(i, j) = paths[k].pose(i * kDecimation, j) +
                       (j < 3 ? s.noise.pose_m : s.noise.pose_rad) * rng.normal();
      }
    }
  }
}

void place(Hidden& h, const std::vector<Path>& paths, const Scenario& s, Rng& rng) {
  const std::size_t k = s.recordings[0].holdout ? 1 : 0;
  const double start = paths[k].start, length = paths[k].time(paths[k].samples()) - start;
  const double a = start + length * rng.uniform(0.2, 0.5);
  const double end = paths.back().time(paths.back().samples() - kDecimation);
  if (h.effect == "contact") h.interval_s = {a, a + rng.uniform(2.0, 6.0)};
  if (h.effect == "step_bias") h.interval_s = {a, end};
}

}  // namespace

const std::vector<std::string>& listed_effects() {
  static const std::vector<std::string> ids{"mass",
                                            "com",
                                            "gravity_tilt",
                                            "coulomb_friction",
                                            "viscous_friction",
                                            "stribeck_friction",
                                            "quadratic_drag",
                                            "lugre_friction",
                                            "hysteresis",
                                            "cable_spring",
                                            "cogging",
                                            "loose_load",
                                            "flexible_resonance",
                                            "contact",
                                            "bias",
                                            "misalignment",
                                            "gain",
                                            "crosstalk",
                                            "time_delay",
                                            "lowpass",
                                            "thermal_drift",
                                            "linear_drift",
                                            "step_bias",
                                            "saturation",
                                            "quantisation",
                                            "hum"};
  return ids;
}

const std::vector<std::string>& unlisted_effects() {
  static const std::vector<std::string> ids{
      "pose_modulated_friction", "velocity_position", "gravity_square", "two_modes",
      "load_friction",           "cubic_spring",      "event_train",    "drifting_lugre"};
  return ids;
}

Scenario draw(const std::string& id, std::uint64_t seed) {
  const auto first = id.find('/'), second = id.rfind('/'), colon = id.find(':');
  require(first != second && colon < first, Exit::kUsage, id, ": write group:value/effect/number");
  Scenario s;
  s.id = id;
  s.group = id.substr(0, first);
  const std::string family = id.substr(0, colon), value = id.substr(colon + 1, first - colon - 1);
  const std::string effect = id.substr(first + 1, second - first - 1);
  Rng rng({seed, hash_of(id)});
  s.tool.mass = rng.uniform(0.3, 1.2);
  s.tool.com = {rng.uniform(-0.01, 0.01), rng.uniform(-0.01, 0.01), rng.uniform(0.05, 0.18)};
  s.noise = {"white", rng.uniform(0.02, 0.06), logarithmic(rng, 5e-6, 5e-5),
             logarithmic(rng, 5e-6, 3e-4)};
  s.motion = one_of<std::string>(rng, {"human", "multisine", "points", "scan", "repeats"});
  if (family == "poor") s.motion = one_of<std::string>(rng, {"harmonic", "planar"});
  if (family == "null" && value == "pose")
    s.noise.pose_m = 5e-5, s.noise.pose_rad = 3e-4;
  else if (family == "null")
    s.noise.kind = value;
  const std::size_t count = rng.uniform() < 0.5 ? 2 : 3, held = count == 2 ? 1 : 1 + rng.below(2);
  std::vector<Path> paths;
  double start = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double seconds = rng.uniform(25.0, 45.0);
    paths.push_back(make_path(s.motion, start, seconds, rng.bits()));
    start = std::ceil(start + seconds + 5.0);
    s.recordings.emplace_back();
    s.recordings.back().holdout = k == held;
    s.recordings.back().name = (k == held ? "holdout" : "fit") + std::to_string(k);
  }
  std::vector<std::string> ids;
  const std::size_t many = family == "doubles" ? 2 : (family == "triples" ? 3 : 1);
  while (family != "null" && ids.size() < many) {
    const std::string next = effect == "any" ? one_of(rng, listed_effects()) : effect;
    if (std::find(ids.begin(), ids.end(), next) == ids.end()) ids.push_back(next);
  }
  s.listed = family != "unlisted";
  s.amplitude = ids.empty() ? 0.0 : std::stod(value);
  std::vector<Eigen::MatrixXd> plain;
  for (const Path& p : paths) plain.push_back(reading(p, s.tool, {}, {}));
  for (const std::string& name : ids) {
    Hidden h{name, draw_axis(name, rng), {}, draw_parameters(name, rng)};
    place(h, paths, s, rng);
    if (has("com misalignment gain crosstalk gravity_tilt", name)) h = scaled(h, 0.01);
    s.hidden.push_back(of_amplitude(paths, plain, s, h, s.amplitude * s.noise.sigma));
  }
  record(s, paths, rng);
  return s;
}

}  // namespace dcnn::conceal
