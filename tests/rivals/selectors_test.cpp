// Each method finds two columns of twenty in little noise, and none where there is only noise.
#include "dcnn/rivals/selectors.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"

namespace dcnn::rivals {
namespace {

using Eigen::Index;

std::vector<Block> problem(double first, double second) {
  Rng rng(3);
  std::vector<Block> blocks;
  for (int k = 0; k < 12; ++k) {
    Eigen::MatrixXd X(250, 20);
    Eigen::VectorXd y(250);
    for (Index i = 0; i < X.rows(); ++i) {
      for (Index j = 0; j < X.cols(); ++j) X(i, j) = rng.normal();
      y(i) = first * X(i, 4) + second * X(i, 11) + 0.1 * rng.normal();
    }
    blocks.push_back({X.transpose() * X, X.transpose() * y, y.squaredNorm(), 250.0});
  }
  return blocks;
}

std::vector<Group> singles() {
  std::vector<Group> groups;
  for (Index c = 0; c < 20; ++c) groups.push_back({c, c + 1});
  return groups;
}

TEST(Selectors, FindTheTwoColumns) {
  for (const Method& method : methods()) {
    const Eigen::VectorXd theta = method.select(problem(0.8, -0.4), singles());
    EXPECT_NEAR(theta(4), 0.8, 0.02) << method.name;
    EXPECT_NEAR(theta(11), -0.4, 0.02) << method.name;
    EXPECT_EQ((theta.array() != 0.0).count(), 2) << method.name;
  }
}

TEST(Selectors, FindNothingInNoise) {
  for (const Method& method : methods()) {
    const Eigen::VectorXd theta = method.select(problem(0.0, 0.0), singles());
    EXPECT_LE((theta.array() != 0.0).count(), 1) << method.name;
  }
}

}  // namespace
}  // namespace dcnn::rivals
