// SPDX-License-Identifier: Apache-2.0
#include "dcnn/rivals/rivals.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "rivals/gram.h"
#include "rivals/library.h"

namespace dcnn::rivals {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
const std::vector<std::string> kForces{"fx", "fy", "fz"};

struct Log {
  Motion motion;
  MatrixXd left;  ///< (T, 3): measured less simulated
};

Recording read(const std::filesystem::path& file) {
  Recording recording = read_recording(file, ReadOptions(), System());
  require(recording.dt > 0.0, Exit::kData, recording.name, ": has no time");
  require(recording.has_all(kForces), Exit::kData, recording.name, ": has no fx,fy,fz");
  return recording;
}

std::vector<Log> logs_of(const std::vector<Recording>& recordings, const ToolModel& tool,
                         const DerivativeSpec& derivative) {
  std::vector<Log> logs;
  for (const Recording& recording : recordings) {
    Log log{motion_of(recording, tool, derivative), {}};
    log.left = recording.block(kForces) - simulate({tool, {}}, log.motion).force;
    logs.push_back(std::move(log));
  }
  return logs;
}

/// Means over 20 ms in blocks of 5 s.
void add_blocks(const Log& log, const MatrixXd& X, const VectorXd& scale,
                std::vector<Block>& blocks) {
  const Index mean = std::max<Index>(1, std::lround(0.02 / log.motion.dt));
  const Index rows = log.left.rows(), length = std::lround(5.0 / log.motion.dt) / mean;
  for (Index start = 0; start + length * mean <= rows; start += length * mean) {
    MatrixXd x(3 * length, X.cols());
    VectorXd y(3 * length);
    for (Index j = 0; j < 3; ++j) {
      for (Index i = 0; i < length; ++i) {
        const Index at = start + i * mean;
        x.row(j * length + i) = X.middleRows(j * rows + at, mean).colwise().mean();
        y(j * length + i) = log.left.col(j).segment(at, mean).mean();
      }
    }
    x = x * scale.asDiagonal();
    blocks.push_back(
        {x.transpose() * x, x.transpose() * y, y.squaredNorm(), static_cast<double>(y.size())});
  }
}

VectorXd unit_scale(const std::vector<MatrixXd>& columns) {
  VectorXd squares = VectorXd::Zero(columns.front().cols());
  double rows = 0.0;
  for (const MatrixXd& X : columns) {
    squares += X.colwise().squaredNorm().transpose();
    rows += static_cast<double>(X.rows());
  }
  return squares.unaryExpr([rows](double s) { return s > 0.0 ? std::sqrt(rows / s) : 0.0; });
}

/// One finding per effect and axis, the strongest first.
Json findings_of(const std::vector<Law>& laws, const VectorXd& theta, const VectorXd& scale,
                 const Block& all) {
  const std::vector<Group> groups = groups_of(laws);
  std::map<std::pair<std::string, std::string>, std::pair<double, Json>> found;
  for (std::size_t k = 0; k < laws.size(); ++k) {
    const Index n = groups[k].end - groups[k].begin;
    const VectorXd part = theta.segment(groups[k].begin, n);
    if (part.isZero(0.0)) continue;
    const double energy = part.dot(all.xx.block(groups[k].begin, groups[k].begin, n, n) * part);
    auto& entry = found[{laws[k].effect, laws[k].axis}];
    if (entry.first >= energy && !entry.second.is_null()) continue;
    const VectorXd amplitudes =
        part.cwiseProduct(scale.segment(groups[k].begin, n)).head(laws[k].fit->amplitudes);
    Json parameters = Json::object();
    const Json values = laws[k].fit->parameters(amplitudes, laws[k].shapes);
    for (const auto& [name, value] : values.items()) {
      parameters[name] = {{"value", value}, {"ci95", nullptr}};
    }
    const Json axis = laws[k].axis.empty() ? Json() : Json(laws[k].axis);
    entry = {energy, Json{{"effect", laws[k].effect},
                          {"axis", axis},
                          {"interval_s", nullptr},
                          {"parameters", parameters},
                          {"alternatives", Json::array()}}};
  }
  std::vector<std::pair<double, Json>> order;
  for (const auto& [key, entry] : found) order.push_back(entry);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Json findings = Json::array();
  for (const auto& [energy, finding] : order) findings.push_back(finding);
  return findings;
}

/// RMSE per axis without the first and last 0.5 s of each recording.
Json rmse(const std::vector<Log>& logs, const std::vector<MatrixXd>& left) {
  Eigen::RowVector3d squares = Eigen::RowVector3d::Zero();
  double rows = 0.0;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const Index ends = std::lround(0.5 / logs[k].motion.dt), n = left[k].rows() - 2 * ends;
    if (n <= 0) continue;
    squares += left[k].middleRows(ends, n).colwise().squaredNorm();
    rows += static_cast<double>(n);
  }
  if (rows == 0.0) return nullptr;
  return {std::sqrt(squares(0) / rows), std::sqrt(squares(1) / rows), std::sqrt(squares(2) / rows)};
}

/// Remainders of the held-out recordings; only laws that were chosen are simulated.
std::vector<MatrixXd> left_of(const std::vector<Log>& logs, const std::vector<Law>& laws,
                              const ToolModel& tool, const VectorXd& theta) {
  const std::vector<Group> groups = groups_of(laws);
  std::vector<Law> chosen;
  std::vector<double> weights;
  for (std::size_t k = 0; k < laws.size(); ++k) {
    const VectorXd part = theta.segment(groups[k].begin, groups[k].end - groups[k].begin);
    if (part.isZero(0.0)) continue;
    chosen.push_back(laws[k]);
    weights.insert(weights.end(), part.begin(), part.end());
  }
  std::vector<MatrixXd> left;
  for (const Log& log : logs) {
    left.push_back(log.left);
    if (chosen.empty()) continue;
    const VectorXd said =
        columns_of(chosen, tool, log.motion) *
        Eigen::Map<const VectorXd>(weights.data(), static_cast<Index>(weights.size()));
    left.back() -= said.reshaped(log.left.rows(), 3);
  }
  return left;
}

/// What the methods choose from.
struct Problem {
  std::vector<Law> laws;
  VectorXd scale;
  std::vector<Block> blocks;
};

Problem problem_of(const std::vector<Log>& logs, const ToolModel& tool, std::vector<Law> laws) {
  Problem problem{std::move(laws), {}, {}};
  std::vector<MatrixXd> columns;
  for (const Log& log : logs) columns.push_back(columns_of(problem.laws, tool, log.motion));
  problem.scale = unit_scale(columns);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    add_blocks(logs[k], columns[k], problem.scale, problem.blocks);
  }
  require(!problem.blocks.empty(), Exit::kData, "the recordings are shorter than 5 s");
  return problem;
}

/// The window with which laws without shapes leave least: a user would try some.
DerivativeSpec best_derivative(const std::vector<Recording>& recordings, const ToolModel& tool,
                               const std::vector<Law>& laws) {
  std::vector<Law> simple = laws;
  std::erase_if(simple, [](const Law& law) { return law.shapes.size() > 0; });
  DerivativeSpec best;
  double least = std::numeric_limits<double>::infinity();
  for (const double window : {0.05, 0.1, 0.2, 0.4}) {
    const DerivativeSpec trial{.window_s = window};
    const Problem problem = problem_of(logs_of(recordings, tool, trial), tool, simple);
    const Block all = sum(problem.blocks);
    Columns every(static_cast<std::size_t>(all.xy.size()));
    std::iota(every.begin(), every.end(), 0);
    const double error = least_squares(all, every).error;
    if (error < least) least = error, best = trial;
  }
  return best;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Json run(const Request& request) {
  const auto start = std::chrono::steady_clock::now();
  const ToolModel tool = read_simulator(request.simulator).model;
  std::vector<Recording> fit, holdout;
  for (const auto& file : request.fit) fit.push_back(read(file));
  for (const auto& file : request.holdout) holdout.push_back(read(file));
  require(!fit.empty(), Exit::kUsage, "no recording to fit");
  const std::vector<Law> laws = library(fit.front().has("temperature"));
  const DerivativeSpec derivative = best_derivative(fit, tool, laws);
  const Problem problem = problem_of(logs_of(fit, tool, derivative), tool, laws);
  const std::vector<Log> unseen = logs_of(holdout, tool, derivative);
  const Block all = sum(problem.blocks);
  const VectorXd nothing = VectorXd::Zero(problem.scale.size());
  const Json before = rmse(unseen, left_of(unseen, laws, tool, nothing));
  const double preparing = seconds_since(start);
  Json reports = Json::object();
  for (const Method& method : methods()) {
    const auto begun = std::chrono::steady_clock::now();
    const VectorXd theta = method.select(problem.blocks, groups_of(laws));
    Json& report = reports[method.name];
    report["findings"] = findings_of(laws, theta, problem.scale, all);
    report["verdict"] = report["findings"].empty() ? "consistent" : "explained";
    report["fit"]["holdout_rmse_before"] = before;
    report["fit"]["holdout_rmse_after"] =
        rmse(unseen, left_of(unseen, laws, tool, theta.cwiseProduct(problem.scale)));
    report["seconds"] = preparing + seconds_since(begun);
  }
  return reports;
}

}  // namespace dcnn::rivals
