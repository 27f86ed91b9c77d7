// SPDX-License-Identifier: Apache-2.0
// A model file behind its checksum: parts that do not belong together are refused.
#include "dcnn/models/identifier.h"

#include <gtest/gtest.h>

#include <functional>

#include "models/support.h"
#include "models/weighted_model.h"
#include "support/process.h"

namespace dcnn {
namespace {

Recording log_of_identifier() {
  return test::exact_recording(test::swinging_tool(), "multisine", 300, 3);
}

Identifier fitted_identifier(bool torques = false) {
  const Recording log = log_of_identifier();
  test::Task task = test::task_of("rigid", log, "body", Json::object(), torques);
  task.problem.layout.spec.derivative = causal_derivative();
  Identifier identifier;
  identifier.name = "rigid";
  identifier.layout = task.problem.layout;
  identifier.targets = task.problem.targets;
  identifier.configuration = task.problem.configuration;
  identifier.seed = 18446744073709551615U;
  identifier.model = test::fitted("rigid", task);
  identifier.online =
      learn_limits(*identifier.model, identifier.targets, task.samples, {}, identifier.layout.dt);
  return identifier;
}

Simulator base_of_identifier(bool with_inertia) {
  Json tool = {{"mass_kg", 0.4}, {"com_m", {0.0, 0.0, 0.1}}};
  if (with_inertia) tool["inertia_kgm2"] = {0.006, 0.006, 0.001, 0.0, 0.0, 0.0};
  return parse_simulator({{"tool", tool}}, "base", Exit::kUsage);
}

/// What unpacking says after a change of one part.
std::string opened(const std::function<void(Container&)>& change) {
  static const Container whole = pack(fitted_identifier());
  Container file = whole;
  change(file);
  try {
    unpack(file, "m.dcnn");
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kModel) << error.what();
    EXPECT_EQ(std::string(error.what()).rfind("m.dcnn", 0), 0U) << error.what();
    return error.what();
  }
  return "";
}

/// The same, with one key of the JSON text of a part set.
std::string opened_with(const std::string& part, const std::string& key, const Json& value) {
  return opened([&](Container& file) {
    Json json = Json::parse(file.metadata[part]);
    json[key] = value;
    file.metadata[part] = json.dump();
  });
}

bool mentions(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(IdentifierFile, IsReadAsItWasWritten) {
  Identifier written = fitted_identifier();
  written.base = base_of_identifier(false);
  const test::TemporaryFolder folder;
  write_container(folder / "m.dcnn", pack(written));
  const Identifier read = read_identifier(folder / "m.dcnn");
  EXPECT_EQ(read.name, "rigid");
  EXPECT_EQ(read.seed, written.seed);
  EXPECT_EQ(read.targets.names, written.targets.names);
  EXPECT_EQ(read.targets.units, written.targets.units);
  EXPECT_EQ(read.configuration, written.configuration);
  EXPECT_EQ(read.online->contact_n, written.online->contact_n);
  const Recording log = log_of_identifier();
  EXPECT_EQ(read.predict(log), written.predict(log));
  EXPECT_GT(read.novelty(log).size() + 1, 0);
  EXPECT_EQ(encode(pack(read)), encode(pack(written)));
  EXPECT_FALSE(fitted_identifier().base);
  Identifier plain = fitted_identifier();
  plain.online.reset();
  const Identifier again = unpack(pack(plain), "m.dcnn");
  EXPECT_FALSE(again.online);
  EXPECT_FALSE(again.base);
}

TEST(IdentifierFile, ThePredictionIsThatOfTheModelAndOfTheBase) {
  const Recording log = log_of_identifier();
  for (const bool torques : {false, true}) {
    Identifier identifier = fitted_identifier(torques);
    const Eigen::MatrixXd alone = identifier.predict(log);
    EXPECT_EQ(identifier.base_prediction(log).norm(), 0.0);
    identifier.base = base_of_identifier(true);
    const Eigen::MatrixXd base = identifier.base_prediction(log);
    EXPECT_EQ(identifier.predict(log), alone + base);
    const Motion motion = motion_of(log, identifier.base->model, identifier.layout.spec.derivative);
    const Wrench wrench = simulate(*identifier.base, motion, nullptr, nullptr);
    ASSERT_EQ(base.cols(), torques ? 6 : 3);
    EXPECT_EQ(base.leftCols(3), wrench.force);
    if (torques) {
      EXPECT_EQ(base.rightCols(3), wrench.torque);
    }
  }
  Identifier identifier = fitted_identifier(true);
  identifier.base = base_of_identifier(false);
  EXPECT_THROW(identifier.base_prediction(log), Error) << "no inertia, no torques";
}

/// A model for dcnn-run has its own causal estimator; another one that of the simulator.
TEST(IdentifierFile, TheBaseIsDifferentiatedAsItsSimulatorSays) {
  const Recording exact = log_of_identifier();
  Recording log = exact;  // its poses alone: rates in a log would be used as they are
  log.table = {};
  log.table.values.resize(exact.samples(), 0);
  for (const char* name : {"t", "x", "y", "z", "alpha", "beta", "gamma"}) {
    log.set(name, exact.column(name));
  }
  Identifier identifier = fitted_identifier();
  identifier.base = base_of_identifier(true);
  const auto with = [&](const DerivativeSpec& spec) {
    const Motion motion = motion_of(log, identifier.base->model, spec);
    return simulate(*identifier.base, motion, nullptr, nullptr).force;
  };
  DerivativeSpec smooth;
  smooth.window_s = 0.06;
  identifier.base->derivative = smooth;
  ASSERT_NE(with(smooth), with(causal_derivative()));
  ASSERT_NE(with(smooth), with(DerivativeSpec()));
  EXPECT_EQ(identifier.base_prediction(log), with(causal_derivative()));
  identifier.layout.spec.derivative = DerivativeSpec();
  EXPECT_EQ(identifier.base_prediction(log), with(smooth));
  identifier.base->derivative.reset();
  EXPECT_EQ(identifier.base_prediction(log), with(DerivativeSpec()));
}

/// A model that leaves nothing in its file.
class SavesNothing : public Model {
 public:
  bool fit(const Samples&, const Samples&, FitSession&) override { return false; }
  Eigen::MatrixXd predict(const Stream& stream) const override { return stream.x; }
  std::unique_ptr<Predictor> predictor() const override { return nullptr; }
  Index parameter_count() const override { return 0; }
  const InputMap& map() const override { return map_; }
  void save(Container&) const override {}

 private:
  InputMap map_;
};

TEST(IdentifierFile, HoldsWhatTheModelItselfDoesNotSave) {
  Identifier written = fitted_identifier();
  const Container whole = pack(written);
  written.model = std::make_unique<SavesNothing>();
  const Container file = pack(written);
  for (const char* key :
       {"format", "format_version", "features", "targets", "configuration", "seed", "online"}) {
    ASSERT_TRUE(file.metadata.contains(key)) << key;
    EXPECT_EQ(file.metadata.at(key), whole.metadata.at(key)) << key;
  }
}

TEST(IdentifierFile, TheWeightsOfItsPredictionsAreRead) {
  Identifier written = fitted_identifier();
  written.model = weighted(std::move(written.model), Eigen::Vector3d(0.25, 0.0, 1.0));
  const Identifier read = unpack(pack(written), "m.dcnn");
  const Recording log = log_of_identifier();
  EXPECT_EQ(read.predict(log), written.predict(log));
  EXPECT_EQ(read.predict(log).col(1).norm(), 0.0);
  EXPECT_GT(read.predict(log).col(0).norm(), 0.0);
}

TEST(IdentifierFile, OfAnotherFormatIsRefused) {
  EXPECT_EQ(opened([](Container&) {}), "");
  const auto set = [](const char* key, const char* value) {
    return opened([&](Container& file) { file.metadata[key] = value; });
  };
  EXPECT_TRUE(mentions(set("format", "dcnn-checkpoint"), "not a model of this program"));
  EXPECT_TRUE(mentions(set("format_version", "2"), "format version 2, this program reads 1"));
  EXPECT_TRUE(mentions(set("model", "transformer"), "transformer"));
  for (const char* key :
       {"format", "format_version", "model", "features", "targets", "configuration", "seed"}) {
    EXPECT_NE(opened([&](Container& file) { file.metadata.erase(key); }), "") << key;
  }
  for (const char* key : {"features", "targets", "configuration", "online"}) {
    EXPECT_NE(set(key, "{"), "") << key;
  }
}

TEST(IdentifierFile, PartsThatDoNotBelongTogetherAreRefused) {
  const Json three = {"fx", "fy", "fz"};
  for (const Json& names :
       {Json{"fx", "fy"}, Json{"fx", "fy", "fz", "tx"}, Json::array(), Json(7), Json{1, 2, 3}}) {
    EXPECT_NE(opened_with("targets", "names", names), "") << names.dump();
  }
  EXPECT_TRUE(mentions(opened_with("targets", "units", {"N"}), "list of targets"));
  EXPECT_TRUE(mentions(
      opened([](Container& file) { file.metadata["targets"] = R"({"names": [], "units": []})"; }),
      "list of targets"));
  EXPECT_TRUE(mentions(opened([](Container& file) {
                         file.metadata["targets"] =
                             R"({"names": ["fx", "fy"], "units": ["N", "N"]})";
                       }),
                       "another number of outputs than its targets"));
  // Features of another set, and an envelope of another model.
  const Recording still = test::exact_recording(test::swinging_tool(), "static", 300, 3);
  const auto layout = test::task_of("rigid", still, "body").problem.layout;
  EXPECT_TRUE(mentions(opened([&](Container& file) {
                         Json other = to_json(layout);
                         file.metadata["features"] = other.dump();
                       }),
                       "another number of rows than its features"));
  EXPECT_TRUE(mentions(opened([&](Container& file) {
                         const Eigen::MatrixXd x = Eigen::MatrixXd::Random(300, 2);
                         Json online = Json::parse(file.metadata["online"]);
                         online["envelope"] = Envelope(x, 0.002).to_json();
                         file.metadata["online"] = online.dump();
                       }),
                       "its envelope has another number of rows"));
}

TEST(IdentifierFile, APrecisionThatTheModelHasNotNamesTheFile) {
  const test::TemporaryFolder folder;
  write_container(folder / "m.dcnn", pack(fitted_identifier()));
  try {
    read_identifier(folder / "m.dcnn", Precision::kInt16);
    ADD_FAILURE() << "taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kUsage);
    EXPECT_TRUE(mentions(error.what(), "m.dcnn")) << error.what();
  }
}

}  // namespace
}  // namespace dcnn
