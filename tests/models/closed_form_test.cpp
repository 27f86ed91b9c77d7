// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "models/inertial.h"
#include "support.h"

namespace dcnn {
namespace {

using test::exact_recording;
using test::fitted;
using test::saved;
using test::swinging_tool;
using test::Task;
using test::task_of;

const std::vector<double>& tensor(const Container& file, const std::string& name) {
  return std::get<std::vector<double>>(file.find(name)->values);
}

double largest_error(const Model& model, const Samples& samples) {
  return (model.predict(samples) - samples.y).cwiseAbs().maxCoeff();
}

TEST(Cf, RecoversWeightAndBiasFromPosesAtRest) {
  const ToolModel tool = swinging_tool();
  const Recording poses = exact_recording(tool, "static", 60, 3);
  for (const char* set : {"pose", "body"}) {
    const Task task = task_of("cf", poses, set);
    const auto model = fitted("cf", task);
    const auto weights = tensor(saved(*model), "weights");  // rows u_x, u_y, u_z, 1
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_NEAR(weights[3 * i + j], i == j ? -9.81 * tool.mass : 0.0, 1e-10);
      }
      EXPECT_NEAR(weights[9 + i], tool.bias[static_cast<Index>(i)], 1e-10);
    }
    EXPECT_TRUE(model->notes().empty());
  }
}

TEST(Cf, SaysSoWhenTheFittedMassIsNegativeWhateverTheMounting) {
  ToolModel tool = swinging_tool();
  for (const double turn : {0.0, 3.1, 1.6}) {
    tool.sensor_rotation_rpy = {turn, 0.2, -turn};
    Task task = task_of("cf", exact_recording(tool, "static", 60, 3), "pose");
    EXPECT_TRUE(fitted("cf", task)->notes().empty());
    task.samples.y *= -1.0;
    const auto notes = fitted("cf", task)->notes();
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("(-0.750 kg)"), std::string::npos) << notes[0];
    task.problem.is_remainder = true;
    EXPECT_TRUE(fitted("cf", task)->notes().empty()) << "what a simulator leaves has no mass";
  }
}

TEST(ClosedForm, HaveTheParameterCountsOfThePaper) {
  const Recording moving = exact_recording(swinging_tool(), "multisine", 500, 3);
  const Json fourier = {{"model", {{"form", "fourier"}}}};
  for (const char* set : {"pose", "body"}) {
    EXPECT_EQ(fitted("ns", task_of("ns", moving, set))->parameter_count(), 0);
    EXPECT_EQ(fitted("cf", task_of("cf", moving, set))->parameter_count(), 12);
    EXPECT_EQ(fitted("cf", task_of("cf", moving, set, fourier))->parameter_count(), 81);
    EXPECT_EQ(fitted("rigid", task_of("rigid", moving, set))->parameter_count(), 48);
    EXPECT_EQ(fitted("rls", task_of("rls", moving, set))->parameter_count(), 48);
    const Task torques = task_of("rigid", moving, set, {{"model", {{"form", "inertial"}}}}, true);
    EXPECT_EQ(fitted("rigid", torques)->parameter_count(), 16);
  }
}

TEST(ClosedForm, FourierTermsContainTheRigidToolAtRest) {
  const Recording poses = exact_recording(swinging_tool(), "static", 300, 3);
  const Recording others = exact_recording(swinging_tool(), "static", 100, 4);
  for (const char* set : {"pose", "body"}) {
    const Task task = task_of("cf", poses, set, {{"model", {{"form", "fourier"}}}});
    EXPECT_LT(largest_error(*fitted("cf", task), test::samples_of(others, task.problem)), 1e-3);
  }
}

TEST(Rigid, PredictsAnotherMotionOfARigidToolExactly) {
  const Recording training = exact_recording(swinging_tool(), "multisine", 3000, 3);
  const Recording other = exact_recording(swinging_tool(), "multisine", 1000, 4);
  for (const char* set : {"pose", "body"}) {
    for (const bool torques : {false, true}) {
      const Task task = task_of("rigid", training, set, Json::object(), torques);
      const Samples held_out = test::samples_of(other, task.problem);
      EXPECT_LT(largest_error(*fitted("rigid", task), held_out), 1e-9) << set << torques;
    }
  }
}

TEST(Rigid, InertialFormRecoversMassCentreAndInertia) {
  const ToolModel tool = swinging_tool();
  const Recording training = exact_recording(tool, "multisine", 3000, 3);
  for (const char* set : {"pose", "body"}) {
    const Task task = task_of("rigid", training, set, {{"model", {{"form", "inertial"}}}}, true);
    const auto model = fitted("rigid", task);
    const Container file = saved(*model);
    EXPECT_EQ(file.metadata.at("constraint_active"), "false");
    const auto p = tensor(file, "inertial");
    const Eigen::Matrix3d I = *tool.inertia;
    InertialParameters wanted;
    wanted << tool.mass, tool.mass * tool.com, I.diagonal(), I(0, 1), I(0, 2), I(1, 2), tool.bias,
        tool.bias_torque;
    for (std::size_t k = 0; k < p.size(); ++k) {
      EXPECT_NEAR(p[k], wanted[static_cast<Index>(k)], 1e-9) << set << " parameter " << k;
    }
    EXPECT_LT(largest_error(*model, task.samples), 1e-8);
  }
}

/// A short motion with strong noise, of which least squares makes an impossible body.
Task noisy_task() {
  Task task = task_of("rigid", exact_recording(swinging_tool(), "multisine", 300, 3), "body",
                      {{"model", {{"form", "inertial"}}}}, true);
  Rng rng(5);
  for (double& value : task.samples.y.reshaped()) value += 0.5 * rng.normal();
  return task;
}

TEST(Rigid, InertialFormIsABodyThatCanExistWhereLeastSquaresIsNot) {
  const Container file = saved(*fitted("rigid", noisy_task()));
  EXPECT_EQ(file.metadata.at("constraint_active"), "true");
  const auto p = tensor(file, "inertial");
  const Eigen::Matrix4d J = pseudo_inertia(Eigen::Map<const InertialParameters>(p.data()));
  const Eigen::Vector4d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(J).eigenvalues();
  EXPECT_GE(values.minCoeff(), -1e-12);
  EXPECT_NEAR(p[0], 0.75, 0.2) << "the mass is well determined";
}

/// The problem is convex in the pseudo-inertia: the constrained fit is the best one if and only if
/// no step towards any other possible body lowers the error.
TEST(Rigid, NoPossibleBodyFitsBetterThanTheConstrainedOne) {
  const Task task = noisy_task();
  const auto columns = wrist_columns(task.problem.layout);
  const auto regressors = make_regressors(task.problem.layout, Terms::kRigid);
  const Eigen::MatrixXd terms = regressors->of(task.samples.x);
  LeastSquares sums(terms.cols(), 6);
  sums.add(terms, task.samples.y);
  const InertialFit fit = fit_inertial(sums, columns);
  ASSERT_TRUE(fit.constraint_active);
  const auto cost = [&](const InertialParameters& p) {
    const Eigen::MatrixXd error = terms * inertial_weights(p, columns) - task.samples.y;
    return error.colwise()
        .squaredNorm()
        .cwiseQuotient(sums.residual_deviation().cwiseAbs2().transpose())
        .sum();
  };
  const double least = cost(fit.parameters);
  Rng rng(8);
  for (int trial = 0; trial < 300; ++trial) {
    InertialParameters other = fit.parameters;
    Eigen::Matrix3d points;  // a body of four point masses
    for (double& value : points.reshaped()) value = rng.uniform(-0.3, 0.3);
    Eigen::Matrix4d J = Eigen::Matrix4d::Zero();
    for (Index k = 0; k < 3; ++k) {
      Eigen::Vector4d q;
      q << points.col(k), 1.0;
      J += rng.uniform(0.0, 0.5) * q * q.transpose();
    }
    const Eigen::Matrix3d S = J.topLeftCorner<3, 3>(),
                          I = S.trace() * Eigen::Matrix3d::Identity() - S;
    other.head<10>() << J(3, 3), J.topRightCorner<3, 1>(), I(0, 0), I(1, 1), I(2, 2), I(0, 1),
        I(0, 2), I(1, 2);
    for (const double step : {1e-3, 1e-2, 1e-1}) {
      const InertialParameters between = (1.0 - step) * fit.parameters + step * other;
      EXPECT_GT(cost(between), least * (1.0 - 3e-4)) << "trial " << trial;
    }
  }
}

TEST(Rigid, InertialFormNeedsTorquesAndSaysSo) {
  const Recording training = exact_recording(swinging_tool(), "multisine", 500, 3);
  const Task task = task_of("rigid", training, "body", {{"model", {{"form", "inertial"}}}});
  try {
    fitted("rigid", task);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kUsage);
    EXPECT_NE(std::string(error.what()).find("regression"), std::string::npos);
  }
}

TEST(ClosedForm, AMotionInOnePlaneDoesNotSpoilAnotherOne) {
  for (const char* kind : {"rigid", "rls"}) {
    Task task = task_of(kind, exact_recording(swinging_tool(), "multisine", 3000, 3), "body");
    const Samples whole = task.samples;
    const auto exact = fitted(kind, task);
    for (const Index column : {1, 6, 7, 12, 13}) task.samples.x.col(column) *= 1e-5;  // u_y, w, dw
    const Eigen::MatrixXd in_plane = exact->predict(task.samples);
    Rng rng(5);
    task.samples.y = in_plane;
    for (double& value : task.samples.y.reshaped()) value += 0.05 * rng.normal();
    // It cannot know what acts outside the plane, but what it invents is no larger than the force.
    const auto regressors = make_regressors(task.problem.layout, Terms::kRigid);
    const Eigen::MatrixXd plain =
        regressors->of(task.samples.x).householderQr().solve(task.samples.y);
    const auto largest = [&](const Eigen::MatrixXd& force) {
      return (force - in_plane).cwiseAbs().maxCoeff();
    };
    EXPECT_LT(largest(fitted(kind, task)->predict(whole)), 7.4) << kind;
    EXPECT_GT(largest(regressors->of(whole.x) * plain), 100.0);
  }
}

TEST(Rls, WeighsTheNewestMost) {
  const Recording recording = exact_recording(swinging_tool(), "multisine", 6000, 3);
  Task task = task_of("rls", recording, "body", {{"model", {{"forgetting", 0.998}}}});
  Samples newest;
  newest.x = task.samples.x.bottomRows(500);
  newest.y = task.samples.y.bottomRows(500);
  task.samples.y.topRows(3000).array() += 5.0;  // another bias in the first half
  const Task batch{task_of("rigid", recording, "body").problem, task.samples};
  EXPECT_GT(largest_error(*fitted("rigid", batch), newest), 2.0);
  EXPECT_LT(largest_error(*fitted("rls", task), newest), 0.2);
}

}  // namespace
}  // namespace dcnn
