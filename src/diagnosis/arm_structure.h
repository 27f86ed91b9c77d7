// SPDX-License-Identifier: Apache-2.0
// What a given arm leaves, as bodies that all joints share beside terms of single joints.
#pragma once

#include "diagnosis/arm_sums.h"

namespace dcnn {

/// Which of several sets of shared parameters, and which further terms of each joint.
struct ArmStructure {
  std::size_t shared = 0;                ///< 0: none
  std::vector<std::vector<Index>> more;  ///< columns of JointRows::own from kOwnFriction on
};

/// The likeliest structure, by prior and by what it predicts of pieces of time that were left out.
/// It grows from an offset and friction in each joint, with bodies first and without them, by what
/// helps most: the next set of shared parameters, or a term of one joint. `shared`: (10·joints, p)
/// each, the first without columns, each an exception to the one before.
class ArmStructureSearch {
 public:
  ArmStructureSearch(const ArmSums& sums, std::vector<Eigen::MatrixXd> shared)
      : sums_(sums), shared_(std::move(shared)) {}

  ArmStructure run() const;
  /// With weights of the joints by what it leaves.
  ArmRegression fitted(const ArmStructure& structure) const;

 private:
  ArmRegression unweighted(const ArmStructure& structure) const;
  double log_prior(const ArmStructure& structure) const;
  /// ln of the odds of a against b.
  double log_odds(const ArmStructure& a, const ArmStructure& b,
                  const Eigen::VectorXd& variances) const;
  ArmStructure climbed(const ArmStructure& from, const Eigen::VectorXd& variances) const;
  ArmStructure with_best_term(const ArmStructure& from, const Eigen::VectorXd& variances) const;
  bool drop_needless(ArmStructure* structure) const;
  ArmStructure grown(ArmStructure now, bool with_bodies) const;

  const ArmSums& sums_;
  std::vector<Eigen::MatrixXd> shared_;
};

}  // namespace dcnn
