// SPDX-License-Identifier: Apache-2.0
#include "runtime/checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dcnn/runtime/serve.h"
#include "runtime/support.h"

namespace dcnn {
namespace {

const Identifier& checked_model() {
  static const Identifier shared = test::trained();
  return shared;
}

double above(double bound) { return std::nextafter(bound, std::numeric_limits<double>::max()); }

/// A number of a sample, how large it may be, and what it is.
struct Bound {
  double& (*number)(OnlineSample&);
  double most;
  const char* what;
};

const Bound kBounds[] = {
    {[](OnlineSample& s) -> double& { return s.t; }, 1e12, "time"},
    {[](OnlineSample& s) -> double& { return s.position[0]; }, 1e3, "x"},
    {[](OnlineSample& s) -> double& { return s.position[1]; }, 1e3, "y"},
    {[](OnlineSample& s) -> double& { return s.position[2]; }, 1e3, "z"},
    {[](OnlineSample& s) -> double& { return s.wrench[0]; }, 1e5, "fx"},
    {[](OnlineSample& s) -> double& { return s.wrench[2]; }, 1e5, "fz"},
    {[](OnlineSample& s) -> double& { return s.wrench[5]; }, 1e5, "tz"},
    {[](OnlineSample& s) -> double& { return (*s.euler)[0]; }, 1e5, "alpha"},
    {[](OnlineSample& s) -> double& { return (*s.euler)[2]; }, 1e5, "gamma"},
};

TEST(Checks, ANumberUpToItsBoundIsPossibleAndNoneBeyond) {
  for (const Bound& bound : kBounds) {
    for (const double sign : {1.0, -1.0}) {
      OnlineSample sample;
      sample.euler = Eigen::Vector3d::Zero();
      bound.number(sample) = sign * bound.most;
      EXPECT_TRUE(is_possible(sample)) << bound.what;
      bound.number(sample) = sign * above(bound.most);
      EXPECT_FALSE(is_possible(sample)) << bound.what;
      for (const double none : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        bound.number(sample) = sign * none;
        EXPECT_FALSE(is_possible(sample)) << bound.what << " " << none;
      }
    }
  }
}

TEST(Checks, AQuaternionIsOfNormOneWithinTheRoundingOfALog) {
  for (int axis = 0; axis < 4; ++axis) {
    for (const double norm : {0.9991, 1.0, 1.0009, -0.9991, -1.0009}) {
      OnlineSample sample;
      sample.quaternion.setZero();
      sample.quaternion[axis] = norm;
      EXPECT_TRUE(is_possible(sample)) << axis << " " << norm;
    }
    for (const double norm : {0.0, 0.9989, 1.0011, -1.0011, std::nan(""), 1e300}) {
      OnlineSample sample;
      sample.quaternion.setZero();
      sample.quaternion[axis] = norm;
      EXPECT_FALSE(is_possible(sample)) << axis << " " << norm;
    }
  }
  OnlineSample unused;  // Euler angles are given: the quaternion says nothing
  unused.quaternion.setConstant(std::nan(""));
  unused.euler = Eigen::Vector3d::Zero();
  EXPECT_TRUE(is_possible(unused));
}

/// cos(beta) below 0.05.
TEST(Checks, EulerAnglesAreSingularWhereTheSecondOneIsNearARightAngle) {
  const auto turned = [](double beta) { return rotation_from_euler({0.3, beta, -0.7}); };
  const double edge = std::acos(0.05);
  for (const double sign : {1.0, -1.0}) {
    EXPECT_FALSE(is_singular(turned(0.0)));
    EXPECT_FALSE(is_singular(turned(sign * (edge - 1e-6))));
    EXPECT_TRUE(is_singular(turned(sign * (edge + 1e-6))));
    EXPECT_TRUE(is_singular(turned(sign * 1.5707963)));
  }
}

void expect_refused(const std::function<void()>& action, const std::string& words) {
  try {
    action();
    ADD_FAILURE() << "taken, without: " << words;
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kModel);
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(Checks, AModelThatCannotRunOnlineIsRefusedWithItsReason) {
  EXPECT_NO_THROW(require_online(checked_model(), "m"));
  Identifier other;
  other.layout = checked_model().layout;
  other.layout.spec.set = FeatureSpec::Set::kAxes;
  expect_refused([&] { require_online(other, "m"); }, "no model of a wrist tool in motion");
  other.layout.spec.set = FeatureSpec::Set::kBody;
  other.layout.dt = 0.0;
  expect_refused([&] { require_online(other, "m"); }, "no model of a wrist tool in motion");
  other.layout.dt = 0.002;
  EXPECT_NO_THROW(require_online(other, "m"));
  other.layout.spec.derivative = DerivativeSpec();
  expect_refused([&] { require_online(other, "m"); }, "train it with --online");
}

TEST(Checks, TargetsAreAForceOrAWrenchInAnyOrder) {
  const auto places = [](std::vector<std::string> names) {
    return wrench_places({names, std::vector<std::string>(names.size(), "N")}, "m");
  };
  EXPECT_EQ(places({"fx", "fy", "fz"}), (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(places({"fz", "fx", "fy"}), (std::vector<Index>{2, 0, 1}));
  EXPECT_EQ(places({"tx", "ty", "tz", "fx", "fy", "fz"}), (std::vector<Index>{3, 4, 5, 0, 1, 2}));
  expect_refused([&] { places({"fx", "fy", "tau"}); }, "predicts 'tau'");
  for (const auto& part : std::vector<std::vector<std::string>>{{"fx"},
                                                                {"fx", "fy"},
                                                                {"fx", "fy", "fy"},
                                                                {"tx", "ty", "tz"},
                                                                {"fx", "fy", "fz", "tx"}}) {
    expect_refused([&] { places(part); }, "must predict fx,fy,fz");
  }
}

/// A rigid model whose prediction for rows one by one is off by a share of what it is for all. It
/// keeps the rows.
class Unfaithful : public Model {
 public:
  Unfaithful(const Model& model, double error) : model_(model), error_(error) {}
  bool fit(const Samples&, const Samples&, FitSession&) override { return false; }
  Eigen::MatrixXd predict(const Stream& stream) const override {
    rows_ = stream.x;
    return model_.predict(stream) * (1.0 + error_);
  }
  std::unique_ptr<Predictor> predictor() const override { return model_.predictor(); }
  Index parameter_count() const override { return 0; }
  const InputMap& map() const override { return model_.map(); }
  void save(Container&) const override {}
  const Eigen::MatrixXd& rows() const { return rows_; }

 private:
  const Model& model_;
  double error_;
  mutable Eigen::MatrixXd rows_;
};

TEST(Checks, APredictorThatDisagreesWithItsModelIsRefused) {
  EXPECT_NE(checked_predictor(checked_model(), "m"), nullptr);
  for (const double error : {0.01, -0.01, std::nan(""), std::numeric_limits<double>::infinity()}) {
    Identifier changed;
    changed.model = std::make_unique<Unfaithful>(*checked_model().model, error);
    expect_refused([&] { checked_predictor(changed, "m"); }, "fails its self-test");
  }
  for (const double error : {1e-5, 9e-4}) {
    Identifier near;
    near.model = std::make_unique<Unfaithful>(*checked_model().model, error);
    EXPECT_NE(checked_predictor(near, "m"), nullptr) << "rounding is no fault";
  }
}

/// Beyond what was learned a network may differ from itself without harm; at its mean alone it
/// could not show a fault.
TEST(Checks, TheSelfTestIsOnRowsLikeThoseLearned) {
  const InputMap& map = checked_model().model->map();
  Identifier watched;
  watched.model = std::make_unique<Unfaithful>(*checked_model().model, 0.0);
  checked_predictor(watched, "m");
  const Eigen::MatrixXd& rows = static_cast<const Unfaithful&>(*watched.model).rows();
  ASSERT_EQ(rows.cols(), map.features());
  for (Index j = 0; j < rows.cols(); ++j) {
    const Eigen::ArrayXd away = (rows.col(j).array() - map.mean()[j]) / map.deviation()[j];
    // 100 draws of a deviation of 0.5: their mean and root mean square within four of their own
    // deviations.
    EXPECT_NEAR(away.mean(), 0.0, 0.2) << j;
    EXPECT_NEAR(std::sqrt(away.square().mean()), 0.5, 0.15) << j;
  }
}

/// Rows of the self-test are forgotten: the first real one meets an empty window.
TEST(Checks, TheSelfTestLeavesNoTrace) {
  const Identifier recursive = test::trained("lstm");
  const auto fresh = recursive.model->predictor();
  const auto checked = checked_predictor(recursive, "m");
  const Eigen::VectorXd x = recursive.model->map().mean() + recursive.model->map().deviation();
  EXPECT_EQ(checked->push(x), fresh->push(x));
}

/// Degrees in the place of radians leave the envelope at once: zeros that nobody explains.
TEST(Checks, ALoopThatNeverWarmedUpSaysWhy) {
  const Json idle{{"states", {{"WARMUP", 7999}, {"NETWORK", 0}}},
                  {"reasons", {{"envelope", 7999}}}};
  EXPECT_NE(warmup_text(idle).find("7999 cycles in WARMUP (7999 envelope)"), std::string::npos)
      << warmup_text(idle);
  const Json done{{"states", {{"WARMUP", 51}, {"NETWORK", 3}}}, {"reasons", {{"envelope", 51}}}};
  EXPECT_EQ(warmup_text(done), "");
  EXPECT_EQ(warmup_text({{"states", {{"WARMUP", 0}}}, {"reasons", Json::object()}}), "");
}

}  // namespace
}  // namespace dcnn
