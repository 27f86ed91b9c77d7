// SPDX-License-Identifier: Apache-2.0
#include "dcnn/conceal/inject.h"

#include <algorithm>
#include <cmath>

#include "conceal/draws.h"
#include "dcnn/conceal/challenge.h"
#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/core/options.h"
#include "dcnn/data/rotation.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
namespace fs = std::filesystem;
const std::vector<std::string> kForces{"fx", "fy", "fz"};

Eigen::Vector3d three(Options& options, const std::string& key) {
  const auto v = options.get(key, std::vector<double>{0.0, 0.0, 0.0});
  if (v.size() != 3) options.reject(key, "must have three numbers");
  return {v[0], v[1], v[2]};
}

Tool read_tool(const fs::path& file) {
  Options options(read_json(file, Exit::kData), file.string(), Exit::kData);
  Options tool = options.child("tool"), sensor = options.child("sensor"),
          model = options.child("model");
  Tool out;
  out.mass = tool.number("mass_kg", 0.0, 0.0, 1e3);
  out.com = three(tool, "com_m");
  out.bias = three(sensor, "bias_n");
  out.mounting = three(sensor, "rotation_rpy");
  out.inertial = model.choice("inertial", "full", {"full", "linear", "none"});
  return out;
}

/// Three running means of 40 ms: like a Gaussian of 20 ms, with steady accelerations.
void smooth(Eigen::MatrixXd& q) {
  constexpr Index kHalf = 80;
  const Index n = q.rows();
  for (int pass = 0; pass < 3; ++pass) {
    const Eigen::MatrixXd from = q;
    const auto row = [&](Index i) { return from.row(std::clamp<Index>(i, 0, n - 1)); };
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(q.cols());
    for (Index i = -kHalf; i <= kHalf; ++i) sum += row(i);
    for (Index i = 0; i < n; ++i) {
      q.row(i) = sum / (2.0 * kHalf + 1.0);
      sum += row(i + kHalf + 1) - row(i - kHalf);
    }
  }
}

/// Values at times `t` of rows that are `step` apart from `start` on.
Eigen::MatrixXd at_times(const Eigen::VectorXd& t, double start, double step,
                         const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd out(t.size(), rows.cols());
  for (Index i = 0; i < t.size(); ++i) {
    const double at = std::max(0.0, (t(i) - start) / step);
    const Index k = std::min(static_cast<Index>(at), rows.rows() - 2);
    out.row(i) = rows.row(k) + (at - static_cast<double>(k)) * (rows.row(k + 1) - rows.row(k));
  }
  return out;
}

/// Columns at 4000 Hz, on straight lines between the samples, then smoothed.
Eigen::MatrixXd resampled(const Eigen::VectorXd& t, const Eigen::MatrixXd& columns) {
  const auto n = static_cast<Index>((t(t.size() - 1) - t(0)) / kStep) + 1;
  Eigen::MatrixXd fine(n, columns.cols());
  for (Index i = 0, k = 0; i < n; ++i) {
    const double now = t(0) + kStep * static_cast<double>(i);
    while (k + 2 < t.size() && t(k + 1) <= now) ++k;
    const double part = (now - t(k)) / (t(k + 1) - t(k));
    fine.row(i) = columns.row(k) + part * (columns.row(k + 1) - columns.row(k));
  }
  smooth(fine);
  return fine;
}

void refuse_gaps(const Recording& recording) {
  require(recording.segments.size() == 1, Exit::kData, recording.name,
          ": has a gap in time; cut it there and give the parts");
}

/// A machine's only axis: along base_x, its position as the angle alpha too.
Path path_along(const Recording& recording, const Axis& axis) {
  refuse_gaps(recording);
  require(recording.has(axis.position), Exit::kData, recording.name, ": has no position '",
          axis.position, "'; an effect needs the motion");
  const Eigen::VectorXd t = recording.column("t");
  Eigen::MatrixXd raw(t.size(), 2);
  raw << recording.column(axis.position), recording.column(axis.measured);
  const Eigen::MatrixXd fine = resampled(t, raw);
  Eigen::MatrixXd pose = Eigen::MatrixXd::Zero(fine.rows(), 6);
  pose.col(0) = pose.col(3) = fine.col(0);
  std::vector<Eigen::Matrix3d> still(static_cast<std::size_t>(fine.rows()),
                                     Eigen::Matrix3d::Identity());
  Path path = follow(t(0), pose, std::move(still), Eigen::Vector3d::Zero());
  path.load = Eigen::MatrixXd::Zero(fine.rows(), 3);
  path.load.col(0) = fine.col(1);
  return path;
}

/// Deviation of white noise, from the median of second differences; of the middle axis.
double noise_of(const Eigen::MatrixXd& force) {
  std::vector<double> sigma;
  for (Index j = 0; j < force.cols(); ++j) {
    std::vector<double> d;
    for (Index i = 1; i + 1 < force.rows(); ++i) {
      d.push_back(std::abs(force(i - 1, j) - 2.0 * force(i, j) + force(i + 1, j)));
    }
    std::nth_element(d.begin(), d.begin() + static_cast<Index>(d.size() / 2), d.end());
    sigma.push_back(d[d.size() / 2] / (0.6745 * std::sqrt(6.0)));
  }
  std::sort(sigma.begin(), sigma.end());
  return sigma[sigma.size() / 2];
}

std::vector<Hidden> parse_hidden(const fs::path& file) {
  const Json list = read_json(file, Exit::kUsage);
  require(list.is_array(), Exit::kUsage, file.string(), ": must hold a list of effects");
  std::vector<Hidden> all;
  for (const Json& item : list) {
    Options options(item, file.string(), Exit::kUsage);
    Hidden h;
    h.effect = options.get<std::string>("effect");
    if (!is_listed(h.effect)) options.reject("effect", "'", h.effect, "' is unknown");
    const Json axis = options.raw("axis"), interval = options.raw("interval_s");
    if (axis.is_string()) h.axis = axis;
    if (interval.is_array() && interval.size() == 2) h.interval_s = {interval[0], interval[1]};
    h.parameters = options.get<std::map<std::string, double>>("parameters");
    options.finish();
    all.push_back(h);
  }
  return all;
}

Hidden draw_hidden(const Injection& request, const Scenario& s, const std::vector<Path>& paths,
                   Rng& rng) {
  const auto at = request.what.find('@');
  Hidden h;
  h.effect = request.what.substr(0, at);
  const auto known = [&](const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), h.effect) != list.end();
  };
  require(is_listed(h.effect) || known(unlisted_effects()), Exit::kUsage, "--inject ", request.what,
          ": neither an effect nor a JSON file");
  h.axis = draw_axis(h.effect, rng);
  if (at != std::string::npos) h.axis = request.what.substr(at + 1);
  do {
    h.parameters = draw_parameters(h.effect, h.axis, rng);
  } while (h.parameters.count("t_ref_degc") != 0);
  place(h, s, paths, rng);
  const auto strong = of_amplitude(paths, s, h, request.amplitude * s.noise.sigma);
  require(strong.has_value(), Exit::kUsage, "--inject ", request.what, ": changes nothing on this ",
          "motion; give another axis, as in coulomb_friction@base_x, or another recording");
  return *strong;
}

void check(const std::vector<Hidden>& hidden) {
  for (const Hidden& h : hidden) {
    require(h.effect != "inertial_terms", Exit::kUsage,
            "--inject: a real tool has its inertial terms; take them out of sim.json instead");
    require(h.parameters.count("t_ref_degc") == 0, Exit::kUsage,
            "--inject: a drift that follows a temperature is not available; give a_x_n … tau_s");
  }
}

}  // namespace

Path path_of(const Recording& recording, const Eigen::Vector3d& mounting) {
  refuse_gaps(recording);
  const Eigen::VectorXd t = recording.column("t");
  Eigen::MatrixXd raw = Eigen::MatrixXd::Zero(t.size(), 10);
  if (recording.has_all({"x", "y", "z"})) raw.leftCols(3) = recording.block({"x", "y", "z"});
  raw.middleCols(3, 3) = euler_angles(recording);
  raw.rightCols(4) = quaternions(recording);
  const Eigen::MatrixXd fine = resampled(t, raw);
  std::vector<Eigen::Matrix3d> rotation;
  for (Index i = 0; i < fine.rows(); ++i) {
    const Eigen::Quaterniond q(fine(i, 6), fine(i, 7), fine(i, 8), fine(i, 9));
    rotation.push_back(q.normalized().toRotationMatrix());
  }
  return follow(t(0), fine.leftCols(6), std::move(rotation), mounting);
}

namespace {

/// What is measured, and of whom.
struct Subject {
  System system;
  Tool tool;
  std::vector<std::string> measured = kForces;
  double sign = 1.0;  ///< of what an effect changes in what is measured
  fs::path description;

  bool is_machine() const { return system.kind == System::Kind::kAxes; }
  Path path(const Recording& log) const {
    if (is_machine()) return path_along(log, system.axes.front());
    require(log.has_all(kForces), Exit::kData, log.name, ": has no fx,fy,fz");
    return path_of(log, tool.mounting);
  }
};

Subject subject_of(const Injection& request) {
  Subject subject;
  if (request.system.empty()) {
    subject.tool = read_tool(request.simulator);
    subject.description = request.simulator;
    return subject;
  }
  subject.system = read_system(request.system);
  require(subject.is_machine() && subject.system.axes.size() == 1, Exit::kData,
          request.system.string(), ": effects are added to machines of one axis");
  subject.tool = {0.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                  "none"};
  subject.measured = {subject.system.axes.front().measured};
  subject.sign = -1.0;
  subject.description = request.system;
  return subject;
}

/// Adds what the effects change on the path.
void add_effects(const Subject& subject, const Path& path, const std::vector<Hidden>& hidden,
                 Recording& log) {
  const Eigen::MatrixXd change = force(path, subject.tool, hidden) - force(path, subject.tool, {});
  Eigen::MatrixXd F = subject.sign * at_times(log.column("t"), path.start, kStep, change);
  for (std::size_t j = 0; j < subject.measured.size(); ++j) {
    F.col(static_cast<Index>(j)) += log.column(subject.measured[j]);
  }
  digitise(hidden, F);
  for (std::size_t j = 0; j < subject.measured.size(); ++j) {
    log.set(subject.measured[j], F.col(static_cast<Index>(j)));
  }
}

}  // namespace

std::string inject(const Injection& request, std::uint64_t seed, const fs::path& folder,
                   const fs::path& seal) {
  const Subject subject = subject_of(request);
  Scenario s;
  s.id = request.what;
  s.group = "injected";
  s.motion = "recorded";
  s.tool = subject.tool;
  std::vector<Recording> logs;
  std::vector<Path> paths;
  for (const fs::path& file : request.motion) {
    logs.push_back(read_recording(file, request.read, subject.system));
    paths.push_back(subject.path(logs.back()));
    s.recordings.emplace_back();
  }
  const double sigma =
      request.noise ? *request.noise : noise_of(logs.front().block(subject.measured));
  require(sigma > 0.0, Exit::kData, logs.front().name, ": its forces have no noise");
  s.noise = {"recorded", sigma, 0.0, 0.0};
  Rng rng({seed, 12});
  const bool listed = fs::path(request.what).extension() == ".json";
  s.hidden = listed ? parse_hidden(request.what)
                    : std::vector<Hidden>{draw_hidden(request, s, paths, rng)};
  check(s.hidden);
  Json answer{{"id", "injected"}};
  answer.update(truth(s));
  answer["oracle_rmse"] = nullptr;
  FileSet files(folder);
  for (const char* earlier : {"sim.json", "system.json"}) files.replaces(earlier);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    add_effects(subject, paths[k], s.hidden, logs[k]);
    write_csv(folder / logs[k].name, logs[k].table);
  }
  write_file(folder / (subject.is_machine() ? "system.json" : "sim.json"),
             read_file(subject.description, 1 << 20, Exit::kData));
  const std::string digest =
      write_seal({{"seed", seed}, {"scenarios", Json::array({answer})}}, folder, seal);
  files.commit();
  return digest;
}

}  // namespace dcnn::conceal
