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

// Two columns a part in a million apart: what they share is found with any ridge, what tells them
// apart is left alone by one above the square of that part.
TEST(Columns, ARidgeHoldsWhatTheyHardlyTellApart) {
  const Eigen::MatrixXd noise = random_columns(500, 3, 3);
  Eigen::MatrixXd A(500, 2);
  A.col(0) = noise.col(0);
  A.col(1) = noise.col(0) + 1e-6 * noise.col(1);
  const Eigen::VectorXd wanted = 3.0 * noise.col(0) + 0.1 * noise.col(1);
  const Eigen::VectorXd free = least_squares(A, wanted, 0.0), held = least_squares(A, wanted, 1e-4);
  EXPECT_GT(free.cwiseAbs().maxCoeff(), 1e4);
  EXPECT_NEAR(held(0), 1.5, 0.02);
  EXPECT_NEAR(held(1), 1.5, 0.02);
  EXPECT_LT((wanted - A * held).norm(), 0.2 * wanted.norm());
}

}  // namespace
}  // namespace dcnn
