// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/given_arm.h"

#include <cmath>

#include "diagnosis/arm_structure.h"
#include "diagnosis/words.h"

namespace dcnn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kHeaviest = 10.0;  // of all that is described: what its links, and their moments
                                    // at 1 m, may differ by
constexpr double kSharedTolerance = 1e-3;  // of a column's length that others must leave

/// 97.5 % quantile of Student's distribution (Cornish and Fisher; within 0.003 from 5 degrees on).
double student_quantile(double freedom) {
  constexpr double z = 1.959963985;
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z, n = freedom;
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

/// (4, joints): mass [kg] and first moments [kg m] of each link, of their (10·joints) parameters.
MatrixXd moments_of(const VectorXd& links) {
  return links.reshaped(10, links.size() / 10).topRows(4);
}

/// Value and half of its 95 % interval: of a number that depends on the shared parameters.
struct Jackknifed {
  double value, half;
};
template <class Number>
Jackknifed jackknife(const std::vector<VectorXd>& without, const VectorXd& all, Number number) {
  const auto n = static_cast<double>(without.size());
  double sum = 0.0, square = 0.0;
  for (const VectorXd& x : without) sum += number(x);
  for (const VectorXd& x : without) square += std::pow(number(x) - sum / n, 2);
  return {number(all), student_quantile(n - 1.0) * std::sqrt((n - 1.0) / n * square)};
}

/// About the centre of mass: xx xy xz yy yz zz.
double central_inertia(const VectorXd& p, Index k) {
  constexpr Index row[] = {0, 0, 0, 1, 1, 2}, col[] = {0, 1, 2, 1, 2, 2};
  const Eigen::Vector3d h = p.segment<3>(1);
  const double steiner = (row[k] == col[k] ? h.squaredNorm() : 0.0) - h[row[k]] * h[col[k]];
  return p[4 + k] - steiner / p[0];
}

class PayloadText {
 public:
  PayloadText(const ArmRegression& regression, Index pieces) : all_(regression.shared(-1)) {
    for (Index p = 0; p < pieces; ++p) without_.push_back(regression.shared(p));
  }

  /// Whether any of mass and moments differs from none.
  bool is_told() const {
    for (Index i = 0; i < 4; ++i) {
      const Jackknifed n = jackknife(without_, all_, [i](const VectorXd& x) { return x[i]; });
      if (std::abs(n.value) > n.half) return true;
    }
    return false;
  }

  Json finding() {
    put("delta_mass_kg", "kg", [](const VectorXd& x) { return x[0]; });
    const Jackknifed mass = jackknife(without_, all_, [](const VectorXd& x) { return x[0]; });
    const bool has_mass = std::abs(mass.value) > mass.half;
    for (Index i = 1; i < 4; ++i) {
      const std::string name =
          std::string(has_mass ? "delta_com_" : "delta_moment_") + "xyz"[i - 1];
      put(name + (has_mass ? "_m" : "_kgm"), has_mass ? "m" : "kg*m",
          [=](const VectorXd& x) { return has_mass ? x[i] / x[0] : x[i]; });
    }
    constexpr const char* kMoments[] = {"xx", "xy", "xz", "yy", "yz", "zz"};
    for (Index k = 0; k < 6 && all_.size() == 10 && has_mass; ++k) {
      put(std::string("delta_inertia_") + kMoments[k] + "_kgm2", "kg*m^2",
          [=](const VectorXd& x) { return central_inertia(x, k); });
    }
    return {{"effect", "payload"},    {"kind", "parameter"},    {"axis", nullptr},
            {"interval_s", nullptr},  {"parameters", numbers_}, {"words", words(has_mass)},
            {"confidence", nullptr},  {"p_value", nullptr},     {"alternatives", Json::array()},
            {"holdout_gain", nullptr}};
  }

 private:
  template <class Number>
  void put(const std::string& name, const std::string& unit, Number number) {
    const Jackknifed n = jackknife(without_, all_, number);
    Json interval = Json::array({n.value - n.half, n.value + n.half});
    numbers_[name] = {{"value", n.value}, {"ci95", interval}, {"unit", unit}};
  }
  std::string words(bool has_mass) const {
    const double m = all_[0], h = all_.segment<3>(1).norm();
    if (!has_mass)
      return "a moment of " + brief(h) + " kg*m at the flange, without a mass that is told";
    const std::string centre = ", centre " + brief(100.0 * h / std::abs(m)) + " cm off";
    if (m > 0.0) return "payload of " + brief(m) + " kg" + centre;
    return brief(-m) + " kg less at the flange than simulated" + centre;
  }

  VectorXd all_;
  std::vector<VectorXd> without_;
  Json numbers_ = Json::object();
};

Json links_finding() {
  return {{"effect", "link_inertia"},
          {"kind", "parameter"},
          {"axis", nullptr},
          {"interval_s", nullptr},
          {"parameters", Json::object()},
          {"words", "links with other masses, centres or inertias than described"},
          {"confidence", nullptr},
          {"p_value", nullptr},
          {"alternatives", Json::array()},
          {"holdout_gain", nullptr}};
}

}  // namespace

MatrixXd told_parameters(const std::vector<JointRows>& rows) {
  MatrixXd stacked(0, rows.front().arm.cols());
  for (const JointRows& joint : rows) {
    const double size = std::max(1e-300, joint.target.norm());
    const Index before = stacked.rows();
    stacked.conservativeResize(before + joint.arm.rows(), Eigen::NoChange);
    stacked.bottomRows(joint.arm.rows()) = joint.arm / size;
  }
  const auto columns = independent_columns(stacked, kSharedTolerance);
  return MatrixXd::Identity(stacked.cols(), stacked.cols())(Eigen::all, columns);
}

GivenArm what_is_missing(const std::vector<JointRows>& rows, const JointChain& chain,
                         const VectorXd& bodies) {
  const ArmSums sums(rows);
  const Index columns = rows.front().arm.cols();
  std::vector<MatrixXd> shared{MatrixXd(columns, 0), MatrixXd::Zero(columns, 4),
                               MatrixXd::Zero(columns, 10)};
  shared[2].bottomRows(10) = flange_to_link(chain);
  shared[1] = shared[2].leftCols(4);
  if (bodies.size() > 0) shared.push_back(told_parameters(rows));

  const ArmStructureSearch search(sums, shared);
  const ArmStructure chosen = search.run();
  GivenArm result;
  if (chosen.shared == 0) return result;
  const ArmRegression regression = search.fitted(chosen);
  const VectorXd x = regression.shared(-1);
  if (chosen.shared == 3) {
    // Where an arm hardly moves, links of tons would follow what its drives give way by.
    const double most = kHeaviest * moments_of(bodies).row(0).cwiseAbs().sum();
    const VectorXd change = shared[chosen.shared] * x;
    if (moments_of(change).cwiseAbs().maxCoeff() > most) return result;
    result.missing = GivenArm::Missing::kLinks;
    result.links = bodies + change;
    result.finding = links_finding();
    return result;
  }
  PayloadText payload(regression, sums.pieces());
  if (!payload.is_told()) return result;
  result.missing = GivenArm::Missing::kPayload;
  result.payload.head(x.size()) = x;
  result.finding = payload.finding();
  return result;
}

}  // namespace dcnn
