// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>

#include "conceal/draws.h"
#include "dcnn/core/error.h"

namespace dcnn::conceal {
namespace {

std::uint64_t hash_of(const std::string& s) {
  std::uint64_t h = 1469598103934665603ULL;  // FNV-1a
  for (char c : s) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return h;
}

/// The parts of "family+group:value/effect/number".
struct Request {
  std::string group, value, effect, family = "plain";
  double amplitude = 0.0;
};

Request parse(const std::string& whole) {
  const auto plus = whole.find('+');
  const std::string id = plus == whole.npos ? whole : whole.substr(plus + 1);
  const auto colon = id.find(':'), first = id.find('/'), second = id.rfind('/');
  require(colon < first && first < second, Exit::kUsage, id, ": write group:value/effect/number");
  Request r{id.substr(0, colon), id.substr(colon + 1, first - colon - 1),
            id.substr(first + 1, second - first - 1)};
  const char* const end = r.value.data() + r.value.size();
  const auto [rest, error] = std::from_chars(r.value.data(), end, r.amplitude);
  const bool number = error == std::errc() && rest == end && r.amplitude > 0.0 && r.amplitude < 1e6;
  require(number || r.group == "null", Exit::kUsage, id, ": '", r.value,
          "' is no amplitude; write a positive number, as in single:0.5/coulomb_friction/7");
  if (r.group == "null") r.amplitude = 0.0;
  if (plus != whole.npos) r.family = whole.substr(0, plus);
  require(has("null faint single foreign poor double triple collinear unlisted mixed law", r.group),
          Exit::kUsage, id, ": no group is called ", r.group);
  const auto known = [](const std::string& name, const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  require(known(r.family, families()), Exit::kUsage, whole, ": no family is called ", r.family);
  require(has("any none", r.effect) || is_listed(r.effect) || known(r.effect, unlisted_effects()) ||
              known(r.effect, drawn_laws()),
          Exit::kUsage, id, ": no effect is called ", r.effect);
  return r;
}

struct Wanted {
  std::string effect;
  double amplitude;
  bool with_axis_of_first = false;
};

/// A listed effect that is distinct beside those already wanted.
std::string another(const std::vector<Wanted>& wanted, Rng& rng) {
  for (;;) {
    const std::string id = one_of(rng, listed_effects());
    if (std::none_of(wanted.begin(), wanted.end(),
                     [&](const Wanted& w) { return w.effect == id || confounded(w.effect, id); })) {
      return id;
    }
  }
}

std::vector<Wanted> choose(const Request& r, Rng& rng) {
  std::vector<Wanted> wanted;
  if (r.group == "null") return wanted;
  const double a = r.amplitude;
  if (r.group == "collinear") {
    const Neighbours pair = one_of(rng, neighbours());
    return {{pair.first, a}, {pair.second, a, pair.same_axis}};
  }
  const bool hardware = r.family == "hardware";
  wanted.push_back({r.effect != "any" ? r.effect
                    : hardware        ? one_of(rng, hardware_effects())
                                      : another(wanted, rng),
                    a});
  const int more = r.group == "triple" ? 2 : (has("double mixed", r.group) ? 1 : 0);
  for (int k = 0; k < more; ++k) {
    const bool weak = rng.uniform() < 0.3;  // one beside another ten times as strong
    wanted.push_back({another(wanted, rng), r.group == "mixed" || !weak ? a : 0.1 * a});
  }
  return wanted;
}

void draw_simulator(const Request& r, const std::vector<Wanted>& wanted, Scenario& s, Rng& rng) {
  s.tool.mass = rng.uniform(0.3, 1.2);
  s.tool.com = {rng.uniform(-0.01, 0.01), rng.uniform(-0.01, 0.01), rng.uniform(0.05, 0.18)};
  for (int j = 0; j < 3; ++j) s.tool.bias(j) = rng.uniform(-1.0, 1.0);
  if (rng.uniform() < 0.2) {
    for (int j = 0; j < 3; ++j) s.tool.mounting(j) = rng.uniform(-0.8, 0.8);
  }
  for (const Wanted& w : wanted) {
    if (w.effect == "inertial_terms") s.tool.inertial = rng.uniform() < 0.5 ? "linear" : "none";
  }
  s.noise = {"white", rng.uniform(0.02, 0.06), logarithmic(rng, 5e-6, 5e-5),
             logarithmic(rng, 5e-6, 3e-4)};
  if (rng.uniform() < 0.4) {
    s.noise.kind = one_of<std::string>(rng, {"ar1", "heteroscedastic", "heavy", "quantised"});
  }
  if (r.group == "null") s.noise.kind = r.value == "pose" ? "white" : r.value;
  if (r.value == "pose") s.noise.pose_m = 5e-5, s.noise.pose_rad = 3e-4;
  s.motion = one_of<std::string>(rng, {"human", "multisine", "points", "scan", "repeats"});
  if (r.group == "poor") s.motion = one_of<std::string>(rng, {"harmonic", "planar"});
}

/// Two or three recordings one after the other on one clock; the last but one or the last is held
/// out.
std::vector<Path> draw_motion(Scenario& s, Rng& rng) {
  const std::size_t count = rng.uniform() < 0.5 ? 2 : 3, held = count == 2 ? 1 : 1 + rng.below(2);
  const Climate climate = s.climate = draw_climate(rng);
  std::vector<Path> paths;
  double start = 0.0;
  int fit = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double drawn = rng.uniform(25.0, 45.0);
    const double seconds = s.conditions.seconds > 0.0 ? s.conditions.seconds : drawn;
    paths.push_back(make_path(s.motion, start, seconds, s.tool.mounting, s.conditions, rng.bits()));
    paths.back().climate = climate;
    start = next_start(start + seconds);
    s.recordings.emplace_back();
    s.recordings.back().holdout = k == held;
    s.recordings.back().name = k == held ? "holdout_0" : "fit_" + std::to_string(fit++);
  }
  return paths;
}

}  // namespace

void place(Hidden& h, const Scenario& s, const std::vector<Path>& paths, Rng& rng) {
  const double start = paths[0].start, length = paths[0].time(paths[0].samples()) - start;
  const double a = start + length * rng.uniform(0.2, 0.5);
  const double end = paths.back().time(paths.back().samples() - s.conditions.samples_per_reading);
  if (h.effect == "contact") h.interval_s = {a, a + rng.uniform(2.0, 6.0)};
  if (h.effect == "step_bias") h.interval_s = {a, end};
}

namespace {

/// How far an amplitude may be from the one asked for; that of inertial terms is the motion's.
constexpr double kNear = 1.25;

double miss_of(const Hidden& h, double asked) {
  return h.effect == "inertial_terms" ? 0.0 : std::abs(std::log(h.amplitude / asked));
}

struct Attempt {
  Scenario scenario;
  double miss = 0.0;  ///< largest abs(log(amplitude / asked))
};

/// Nothing where one of the effects changes nothing on its motion.
std::optional<Attempt> attempt(const std::string& id, const Request& request, Rng rng) {
  Attempt made;
  Scenario& s = made.scenario;
  s.id = id;
  s.group = request.group;
  const std::vector<Wanted> wanted = choose(request, rng);
  draw_simulator(request, wanted, s, rng);
  if (request.family != "plain") s.conditions = draw_conditions(request.family, rng);
  if (s.conditions.torque_m > 0.0) draw_body(s.tool, rng);
  const std::vector<Path> paths = draw_motion(s, rng);
  bool thermometer = rng.uniform() < 0.3;
  for (const Wanted& w : wanted) {
    Hidden h;
    h.effect = undriven(w.effect);
    h.axis = w.with_axis_of_first ? s.hidden[0].axis : draw_axis(h.effect, rng);
    h.parameters = draw_parameters(h.effect, h.axis, rng);
    if (h.effect != w.effect) draw_drive(h, rng);
    if (s.conditions.torque_m > 0.0) draw_torques(h, rng);
    h.foreign = request.group == "foreign";
    thermometer =
        thermometer || h.parameters.count("t_ref_degc") != 0 || h.parameters.count("slope") != 0;
    place(h, s, paths, rng);
    const auto strong = of_amplitude(paths, s, h, w.amplitude * s.noise.sigma);
    if (!strong) return std::nullopt;
    s.hidden.push_back(*strong);
    made.miss = std::max(made.miss, miss_of(*strong, w.amplitude));
  }
  record(s, paths, thermometer, rng);
  return made;
}

}  // namespace

Scenario draw(const std::string& id, std::uint64_t seed) {
  constexpr std::uint64_t kAttempts = 50;
  const Request request = parse(id);
  std::optional<Attempt> nearest;
  for (std::uint64_t k = 0; k < kAttempts; ++k) {
    const Rng rng = k == 0 ? Rng({seed, hash_of(id)}) : Rng({seed, hash_of(id), k});
    auto made = attempt(id, request, rng);
    if (made && (!nearest || made->miss < nearest->miss)) nearest = std::move(made);
    if (nearest && nearest->miss <= std::log(kNear)) break;
  }
  require(nearest.has_value(), Exit::kUsage, id, ": ", request.effect,
          " changes nothing on any of ", kAttempts, " motions of seed ", seed,
          "; give another seed");
  return std::move(nearest->scenario);
}

}  // namespace dcnn::conceal
