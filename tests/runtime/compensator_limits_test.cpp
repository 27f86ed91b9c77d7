// What a compensator may be made of, and what its options change: warm-up, torques, contact,
// limits.
#include <gtest/gtest.h>

#include <functional>

#include "runtime/support.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

/// A model that predicts the same for every sample.
class SteadyModel : public Model {
 public:
  SteadyModel(const InputMap& map, Eigen::VectorXd y) : map_(map), y_(std::move(y)) {}
  bool fit(const Samples&, const Samples&, FitSession&) override { return false; }
  Eigen::MatrixXd predict(const Stream& stream) const override {
    return y_.transpose().replicate(stream.x.rows(), 1);
  }
  std::unique_ptr<Predictor> predictor() const override { return std::make_unique<Steady>(y_); }
  Index parameter_count() const override { return 0; }
  const InputMap& map() const override { return map_; }
  void save(Container&) const override {}

 private:
  struct Steady : Predictor {
    explicit Steady(Eigen::VectorXd value) : y(std::move(value)) {}
    void reset() noexcept override {}
    const Eigen::VectorXd& push(const Eigen::VectorXd&) noexcept override { return y; }
    Eigen::VectorXd y;
  };
  InputMap map_;
  Eigen::VectorXd y_;
};

const Recording& slow_motion() {
  static const Recording shared = test::free_motion(600);
  return shared;
}

/// A model of a wrench, which says `y`, on features of a set.
Identifier steady_identifier(const Eigen::VectorXd& y,
                             FeatureSpec::Set set = FeatureSpec::Set::kBody) {
  static const Identifier body = test::trained();
  Identifier identifier;
  FeatureSpec spec = body.layout.spec;
  spec.set = set;
  identifier.layout = make_layout({slow_motion()}, spec, {});
  identifier.targets = {{"fx", "fy", "fz"}, {"N", "N", "N"}};
  if (y.size() == 6) {
    identifier.targets = {{"fx", "fy", "fz", "tx", "ty", "tz"}, {"N", "N", "N", "Nm", "Nm", "Nm"}};
  }
  identifier.model = std::make_unique<SteadyModel>(body.model->map(), y);
  return identifier;
}

Simulator tool_with_inertia(bool has_inertia, double rate_hz = 500.0) {
  Json tool = {{"mass_kg", 0.75}, {"com_m", {0.0, 0.0, 0.1}}};
  if (has_inertia) tool["inertia_kgm2"] = {0.006, 0.006, 0.001, 0.0, 0.0, 0.0};
  return parse_simulator({{"tool", tool}, {"sample_rate_hz", rate_hz}}, "test", Exit::kUsage);
}

OnlineSample standing_sample(Index k, double dt = 0.002) {
  OnlineSample sample;
  sample.t = static_cast<double>(k) * dt;
  return sample;
}

void expect_unmade(const std::function<void()>& make, const std::string& words) {
  try {
    make();
    ADD_FAILURE() << "made, without: " << words;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

/// Cycles of warm-up of a simulator alone.
int warmup_of(const Simulator& simulator, const CompensatorOptions& options) {
  OnlineCompensator compensator(nullptr, &simulator, options, "test");
  int cycles = 0;
  while (cycles < 1000 &&
         compensator.step(standing_sample(cycles, compensator.dt())).state == RunState::kWarmup) {
    ++cycles;
  }
  return cycles;
}

TEST(CompensatorLimits, AnAverageIsOverOneToSixteenReadings) {
  const Simulator simulator = tool_with_inertia(false);
  CompensatorOptions options;
  for (const int average : {1, 16}) {
    options.average = average;
    EXPECT_NO_THROW(OnlineCompensator(nullptr, &simulator, options, "test")) << average;
  }
  for (const int average : {-1, 0, 17, 1000}) {
    options.average = average;
    expect_unmade([&] { OnlineCompensator(nullptr, &simulator, options, "test"); },
                  "the average must be over 1 to 16 readings");
  }
}

TEST(CompensatorLimits, NothingAndAModelThatLooksAheadAreRefused) {
  expect_unmade([] { OnlineCompensator(nullptr, nullptr, {}, "test"); },
                "neither a model nor a simulator");
  Identifier ahead = steady_identifier(Vector3d::Zero());
  ahead.layout.spec.derivative = DerivativeSpec();
  expect_unmade([&] { OnlineCompensator(&ahead, nullptr, {}, "test"); }, "look into the future");
}

/// The guard waits until the windows of the derivatives are full, and no less than it was told.
TEST(CompensatorLimits, TheWarmUpIsThatOfTheLongerWindow) {
  CompensatorOptions options;
  options.guard.warmup_cycles = 3;
  Simulator simulator = tool_with_inertia(false);
  const int full = static_cast<int>(causal_derivative().window(0.002));
  const int usual = warmup_of(simulator, options);
  EXPECT_EQ(usual, full);
  DerivativeSpec brief = causal_derivative();
  brief.window_s = 0.04;
  simulator.derivative = brief;
  EXPECT_EQ(warmup_of(simulator, options) - usual, static_cast<int>(brief.window(0.002)) - full);
  DerivativeSpec ahead;  // not for the loop: the usual one takes its place
  ahead.window_s = 0.04;
  simulator.derivative = ahead;
  EXPECT_EQ(warmup_of(simulator, options), usual);
  const Simulator slower = tool_with_inertia(false, 250.0);
  EXPECT_EQ(warmup_of(slower, options) - usual,
            static_cast<int>(causal_derivative().window(0.004)) - full);
  options.guard.warmup_cycles = 200;
  EXPECT_EQ(warmup_of(tool_with_inertia(false), options), 200);
}

TEST(CompensatorLimits, TimeAndDerivativesAreTheModels) {
  Identifier slow = steady_identifier(Vector3d::Zero());
  slow.layout.dt = 0.004;
  slow.layout.spec.derivative.window_s = 0.4;
  CompensatorOptions options;
  options.guard.warmup_cycles = 3;
  OnlineCompensator compensator(&slow, nullptr, options, "test");
  EXPECT_EQ(compensator.dt(), 0.004);
  const int full = static_cast<int>(slow.layout.spec.derivative.window(0.004));
  for (int k = 0; k < full; ++k) {
    ASSERT_EQ(compensator.step(standing_sample(k, 0.004)).state, RunState::kWarmup) << k;
  }
  EXPECT_EQ(compensator.step(standing_sample(full, 0.004)).state, RunState::kNetwork);
}

TEST(CompensatorLimits, TorquesArePredictedWhereAllThatPredictsDoes) {
  const Identifier force = steady_identifier(Vector3d::Zero());
  const Identifier wrench = steady_identifier(Eigen::VectorXd::Zero(6));
  const Simulator plain = tool_with_inertia(false), whole = tool_with_inertia(true);
  const auto torque = [](const Identifier* network, const Simulator* physics) {
    return OnlineCompensator(network, physics, {}, "test").has_torque();
  };
  EXPECT_FALSE(torque(nullptr, &plain));
  EXPECT_TRUE(torque(nullptr, &whole));
  EXPECT_FALSE(torque(&force, nullptr));
  EXPECT_TRUE(torque(&wrench, nullptr));
  EXPECT_FALSE(torque(&force, &plain));
  EXPECT_FALSE(torque(&force, &whole));
  EXPECT_TRUE(torque(&wrench, &whole));
  expect_unmade([&] { torque(&wrench, &plain); }, "give its tool an inertia");
}

TEST(CompensatorLimits, ItsGuardHasTheLimitsThatAreGiven) {
  const Identifier model = steady_identifier(Vector3d::Zero());
  CompensatorOptions options;
  options.guard.force_n = 2.0;
  OnlineCompensator compensator(&model, nullptr, options, "test");
  for (Index k = 0; k < 200; ++k) {
    OnlineSample sample = standing_sample(k);
    sample.wrench[0] = 30.0;
    const auto& result = compensator.step(sample);
    ASSERT_LE(result.external.cwiseAbs().maxCoeff(), 2.0) << k;
  }
}

/// A force is contact by its mean over 50 ms, 25 samples.
TEST(CompensatorLimits, ContactIsAForceThatLasts) {
  const Identifier model = steady_identifier(Vector3d::Zero());
  CompensatorOptions options;
  options.contact_n = 1.0;
  OnlineCompensator compensator(&model, nullptr, options, "test");
  Index k = 0;
  const auto press = [&](double force) {
    OnlineSample sample = standing_sample(k++);
    sample.wrench[0] = force;
    return compensator.step(sample).contact;
  };
  while (k < 100) ASSERT_FALSE(press(0.0));
  EXPECT_FALSE(press(20.0)) << "a blow of one sample";
  while (k < 200) ASSERT_FALSE(press(0.0));
  for (int held = 1; held <= 25; ++held) EXPECT_EQ(press(2.0), held > 12) << held;
  // Let go: contact ends below half of the threshold.
  for (int free = 1; free <= 25; ++free) EXPECT_EQ(press(0.0), free <= 18) << free;
}

TEST(CompensatorLimits, OnlyAnglesAsFeaturesAreSingular) {
  for (const auto set : {FeatureSpec::Set::kPose, FeatureSpec::Set::kBody}) {
    const Identifier model = steady_identifier(Vector3d::Zero(), set);
    OnlineCompensator compensator(&model, nullptr, {}, "test");
    bool singular = false;
    for (Index k = 0; k < 400; ++k) {
      OnlineSample sample = standing_sample(k);
      sample.euler = Vector3d(0.0, k < 200 ? 0.0 : 1.5707963, 0.0);
      singular = compensator.step(sample).reason == Reason::kSingular || singular;
      ASSERT_TRUE(!singular || k >= 200) << k;
    }
    EXPECT_EQ(singular, set == FeatureSpec::Set::kPose);
  }
}

}  // namespace
}  // namespace dcnn
