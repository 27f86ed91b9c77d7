// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/budget.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/linear_algebra.h"
#include "diagnosis/budget_columns.h"
#include "diagnosis/scan.h"

namespace dcnn {
namespace {

constexpr int kFolds = 5;
constexpr double kBlock = 2.0;        // s
constexpr double kEventBlock = 0.25;  // s, inside a push
constexpr double kRidge = 1e-6;

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// What fits to all blocks but a fifth explain of that fifth, block by block.
class CrossValidation {
 public:
  CrossValidation(const Setting& setting, const std::vector<Index>& rows, double seconds) {
    std::map<std::pair<std::uint32_t, std::int64_t>, std::size_t> blocks;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto& at = setting.whitener.row_info()[static_cast<std::size_t>(rows[i])];
      const auto number = static_cast<std::int64_t>(std::floor(at.t / seconds));
      const std::size_t block = blocks.try_emplace({at.log, number}, blocks.size()).first->second;
      if (block == rows_.size()) rows_.emplace_back();
      rows_[block].push_back(static_cast<Index>(i));
    }
  }
  Vector explained(const Matrix& X, const Vector& y) const {
    std::vector<Matrix> gram(kFolds, Matrix::Zero(X.cols(), X.cols()));
    std::vector<Vector> match(kFolds, Vector::Zero(X.cols()));
    for (std::size_t b = 0; b < rows_.size(); ++b) {
      const Matrix part = X(rows_[b], Eigen::all);
      gram[b % kFolds] += part.transpose() * part;
      match[b % kFolds] += part.transpose() * y(rows_[b]);
    }
    Matrix all = Matrix::Zero(X.cols(), X.cols());
    Vector to = Vector::Zero(X.cols());
    for (int f = 0; f < kFolds; ++f) all += gram[std::size_t(f)], to += match[std::size_t(f)];
    std::vector<Vector> fits;
    for (std::size_t f = 0; f < kFolds; ++f) {
      fits.emplace_back(X.cols() == 0 ? Vector(0)
                                      : Vector(solve_gram(all - gram[f], to - match[f], kRidge)));
    }
    Vector gain(static_cast<Index>(rows_.size()));
    for (std::size_t b = 0; b < rows_.size(); ++b) {
      const Vector target = y(rows_[b]);
      gain(static_cast<Index>(b)) =
          target.squaredNorm() -
          (target - X(rows_[b], Eigen::all) * fits[b % kFolds]).squaredNorm();
    }
    return gain;
  }

 private:
  std::vector<std::vector<Index>> rows_;
};

/// What the columns, fitted everywhere else, leave in the rows of the segments.
struct InSegments {
  std::vector<Index> whitened, kept;  // the same rows, in the whitener and among those kept
  Vector left;
};

InSegments in_segments(const Setting& setting, const BudgetColumns& columns, const Vector& y,
                       const Json& segments) {
  InSegments in;
  std::vector<Index> elsewhere;
  for (std::size_t i = 0; i < columns.rows().size(); ++i) {
    const auto& at = setting.whitener.row_info()[static_cast<std::size_t>(columns.rows()[i])];
    const std::string& name = setting.study.logs[at.log].motion.recording;
    const bool inside = std::any_of(segments.begin(), segments.end(), [&](const Json& s) {
      const Json& span = s["interval_s"];
      return at.t >= span[0].get<double>() && at.t <= span[1].get<double>() &&
             (!s.contains("recording") || s["recording"].get<std::string>() == name);
    });
    if (inside) in.whitened.push_back(columns.rows()[i]);
    (inside ? in.kept : elsewhere).push_back(static_cast<Index>(i));
  }
  const Matrix X = columns.all()(elsewhere, Eigen::all);
  const Vector c = solve_gram(X.transpose() * X, X.transpose() * y(elsewhere), kRidge);
  in.left = y(in.kept) - columns.all()(in.kept, Eigen::all) * c;
  return in;
}

}  // namespace

Json budget(const Setting& setting, const Signals& left, const std::vector<Member>& own,
            const Json& segments) {
  Json list = Json::array();
  if (setting.study.is_static()) return list;
  BudgetColumns columns(setting);
  const Vector y = setting.whitened(left)(columns.rows());
  const double energy = y.squaredNorm(), noise = static_cast<double>(y.size());
  const JointFit given = joint_fit(setting, {});
  const Scan scan(setting, given);
  if (!(energy > 0.0)) return list;  // what is simulated is what was measured
  double room = std::max(0.0, 1.0 - noise / energy);
  const auto add_part = [&](const char* part, const Vector& gain) {
    const double n = static_cast<double>(gain.size()), mean = gain.size() > 0 ? gain.mean() : 0.0;
    const double deviation = std::sqrt((gain.array() - mean).square().sum() / std::max(1.0, n - 1));
    const double share = std::clamp(gain.sum() / energy, 0.0, room);
    room -= share;
    list.push_back({{"part", part},
                    {"share", share},
                    {"z", deviation > 0.0 ? mean / deviation * std::sqrt(n) : 0.0}});
  };
  const CrossValidation folds(setting, columns.rows(), kBlock);
  Vector before = folds.explained(Matrix(y.size(), 0), y);
  const auto add_kind = [&](const char* part) {
    const Vector now = folds.explained(columns.all(), y);
    add_part(part, now - before);
    before = now;
  };
  for (const Member& member : own) columns.add_whitened(scan.columns(member, Detail::kCoarse));
  add_kind("parameter");
  add_state(columns);
  add_kind("state");
  add_memory(columns, scan.coarse_prediction());
  add_kind("memory");
  add_clock(columns);
  add_kind("clock");
  const InSegments in = in_segments(setting, columns, y, segments);
  BudgetColumns pushes(setting);
  add_events(pushes, segments);
  if (pushes.all().cols() > 0) {
    const Matrix X = pushes.all()(in.kept, Eigen::all);
    add_part("event", CrossValidation(setting, in.whitened, kEventBlock).explained(X, in.left));
  } else {
    add_part("event", Vector(0));
  }
  list.push_back({{"part", "noise"}, {"share", std::min(1.0, noise / energy)}, {"z", nullptr}});
  list.push_back({{"part", "other"}, {"share", room}, {"z", nullptr}});
  return list;
}

}  // namespace dcnn
