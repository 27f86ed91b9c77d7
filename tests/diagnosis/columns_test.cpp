// SPDX-License-Identifier: Apache-2.0
// Columns of a regression against what linear algebra says of them.
#include "diagnosis/columns.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

Eigen::MatrixXd random_columns(Eigen::Index rows, Eigen::Index count, std::uint64_t seed) {
  Rng rng({seed});
  Eigen::MatrixXd columns(rows, count);
  for (double& x : columns.reshaped()) x = rng.normal();
  return columns;
}

// More rows than a block of the projection has, and not a multiple of them.
TEST(Columns, OffABasisAreTheirResiduals) {
  const Eigen::MatrixXd basis = orthonormal(random_columns(1300, 7, 1));
  Eigen::MatrixXd columns = random_columns(1300, 3, 2);
  columns.col(1) = basis * Eigen::VectorXd::LinSpaced(7, 1.0, 2.0);  // imitated
  const Eigen::MatrixXd off = off_basis(columns, basis);
  for (const Eigen::Index k : {0, 2}) {
    const Eigen::VectorXd expected =
        columns.col(k) - basis * (basis.transpose() * columns.col(k)).eval();
    EXPECT_LT((off.col(k) - expected).norm(), 1e-12 * columns.col(k).norm());
  }
  EXPECT_TRUE(off.col(1).isZero(0.0));
  EXPECT_LT((basis.transpose() * off).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace dcnn
