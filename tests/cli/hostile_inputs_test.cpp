// SPDX-License-Identifier: Apache-2.0
// What an attacker or a broken logger writes: one line that says what is wrong, and nothing that a
// terminal obeys.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <functional>

#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"
#include "dcnn/core/json.h"
#include "support/process.h"

namespace dcnn {
namespace {

const std::string kSampleTool = DCNN_SOURCE_DIR "/data/sample/sim.json";

class HostileInputs : public testing::Test {
 protected:
  std::string at(const std::string& name) const { return folder_ / name; }

  /// A recording of 12 s at 50 Hz; `change` sees time and row and may set its cells.
  using Row = std::map<std::string, double>;
  std::string log(const std::string& name, const std::function<void(double, Row&)>& change) const {
    std::ostringstream text;
    text.precision(10);
    for (int i = 0; i < 600; ++i) {
      const double t = 0.02 * i, b = 0.6 * std::sin(1.1 * t), c = 3.0 + 0.5 * std::sin(0.9 * t);
      Row row{{"t", t},
              {"x", 0.1 * std::sin(0.8 * t)},
              {"y", 0.1 * std::sin(1.7 * t)},
              {"z", 0.1 * std::cos(t)},
              {"alpha", 0.5 * std::sin(0.7 * t)},
              {"beta", b},
              {"gamma", c},
              {"fx", 7.0 * std::sin(b)},
              {"fy", -7.0 * std::cos(b) * std::sin(c)},
              {"fz", -7.0 * std::cos(b) * std::cos(c)}};
      change(t, row);
      const char* comma = "";
      for (const auto& [key, value] : row) {
        if (i == 0) text << std::exchange(comma, ",") << key;
      }
      if (i == 0) text << "\n";
      comma = "";
      for (const auto& [key, value] : row) text << std::exchange(comma, ",") << value;
      text << "\n";
    }
    write_file(at(name), text.str());
    return at(name);
  }

  void expect_line(const test::Result& result, int exit, const std::string& words) const {
    EXPECT_EQ(result.exit_code, exit) << result.err;
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("internal error"), std::string::npos) << result.err;
    EXPECT_LT(result.err.size(), 3000U);
    EXPECT_EQ(result.err.find('\x1b'), std::string::npos);
  }

  test::Result train(const std::string& log, const std::string& model = "rigid") const {
    return test::run("train", {"--train", log, "--model", model, "--preset", "quick", "--out",
                               at(model + ".dcnn"), "--force"});
  }

  test::TemporaryFolder folder_;
};

TEST_F(HostileInputs, ForcesThatNoSensorReadsAreRefused) {
  const std::string huge =
      log("huge.csv", [](double t, Row& row) { row["fx"] = t > 5 ? 1e300 : row["fx"]; });
  expect_line(test::run("diagnose", {"--sim", kSampleTool, "--fit", huge, "--out", at("report")}),
              3, "huge.csv:253: column 'fx' is 1e+300");
  expect_line(train(huge), 3, "beyond any sensor");
}

TEST_F(HostileInputs, NothingIsLearnedFromNothing) {
  const auto zero = [](double, Row& row) { row["fx"] = row["fy"] = row["fz"] = 0.0; };
  expect_line(train(log("zero.csv", zero)), 3, "fx is exactly 0");
  const auto still = [](double t, Row& row) {
    row = {{"t", t},     {"x", 0.1},  {"y", 0},     {"z", 0},
           {"alpha", 0}, {"beta", 0}, {"gamma", 3}, {"fx", std::sin(40 * t)},
           {"fy", 0.1},  {"fz", -7}};
  };
  expect_line(train(log("still.csv", still)), 3, "nothing moves");
  expect_line(train(log("still.csv", still), "mlp"), 3, "nothing moves");
  const auto dead = [](double, Row& row) { row["fy"] = 0.25; };
  expect_line(train(log("dead.csv", dead)), 3, "fy is exactly 0.25");
}

TEST_F(HostileInputs, ADeadChannelIsNamedAndNotExplained) {
  const auto dead = [](double, Row& row) { row["fz"] = 1.5; };
  expect_line(test::run("diagnose", {"--sim", kSampleTool, "--fit", log("dead.csv", dead), "--out",
                                     at("report")}),
              3, "dead.csv: frozen: fz is exactly 1.5");
}

/// Contract, section 2: NaN is an error in any column, and the line says which.
TEST_F(HostileInputs, ANumberThatIsNoneIsRefusedInUnusedColumnsToo) {
  const auto nan = [](double t, Row& row) {
    row["voltage"] = t > 3.99 && t < 4.01 ? std::nan("") : 24.0;
  };
  expect_line(train(log("nan.csv", nan)), 3, "nan.csv:202: column 'voltage' is not finite");
}

TEST_F(HostileInputs, AResamplingMakesNoMoreRowsThanTheMemoryHolds) {
  const std::string plain = log("a.csv", [](double, Row&) {});
  expect_line(test::run("diagnose", {"--sim", kSampleTool, "--fit", plain, "--resample", "1e9",
                                     "--out", at("report")}),
              2, "--resample: 1e9 is not between");
}

TEST_F(HostileInputs, KeysAndValuesOfADocumentObeyNoTerminalAndStayShort) {
  const std::string plain = log("a.csv", [](double, Row&) {});
  const std::string huge(300'000, 'x');
  for (const std::string& text :
       {std::string(R"({"tool\u001b[31m": {}, "gravity": "\u001b]0;owned\u0007"})"),
        "{\"" + huge + "\": 1}", "{\"tool\": \"" + huge + "\"}",
        "{\"tool\": {\"mass_kg\": \"" + huge + "\"}}"}) {
    write_file(at("sim.json"), text);
    expect_line(
        test::run("diagnose", {"--sim", at("sim.json"), "--fit", plain, "--out", at("report")}), 3,
        "sim.json");
    write_file(at("config.json"), text);
    expect_line(test::run("train",
                          {"--config", at("config.json"), "--train", plain, "--out", at("m.dcnn")}),
                2, "config.json");
  }
}

TEST_F(HostileInputs, AFolderThatCannotBeMadeIsOneLine) {
  const std::string plain = log("a.csv", [](double, Row&) {});
  expect_line(
      test::run("diagnose", {"--sim", kSampleTool, "--fit", plain, "--out", plain + "/below"}), 1,
      "a.csv");
  expect_line(
      test::run("conceal", {"--scenarios", "1", "--out", plain + "/below", "--seal", at("s.json")}),
      1, "a.csv");
  expect_line(
      test::run("train", {"--train", plain, "--model", "rigid", "--out", plain + "/below/m.dcnn"}),
      1, "a.csv");
}

/// A seal whose SHA-256 is right, but which nobody of ours wrote.
TEST_F(HostileInputs, ForgedSealsAreRefused) {
  for (
      const char* seal :
      {"{}", "[]", R"({"seed": 1, "scenarios": 3})",
       R"({"seed": 1, "scenarios": [{"id": "s0001"}]})",
       R"({"seed": 1, "scenarios": [{"id": 7, "group": "single", "drawn": "single:abc/bias/1"}]})"}) {
    write_file(at("seal.json"), seal);
    write_file(at("set/seal.sha256"), sha256_hex({seal}) + "  seal.json\n");
    write_file(at("set/reports/s0001/report.json"),
               R"({"findings": [{"effect": 1}], "verdict": null})");
    expect_line(test::run("conceal", {"--score", "--out", at("set"), "--seal", at("seal.json")}), 3,
                "seal.json");
  }
}

/// A file name may hold any bytes; JSON and pages hold characters.
TEST_F(HostileInputs, NamesThatAreNoUtf8LoseNoResult) {
  const std::string odd = log("l\xff.csv", [](double, Row&) {});
  const auto checked = test::run("check", {odd, "--json", "--out", at("check")});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_NO_THROW(parse_json(checked.out, "stdout", Exit::kFailure));
  EXPECT_NO_THROW(read_json(at("check/check.json"), Exit::kFailure));
}

TEST_F(HostileInputs, AFifoIsNoLogAndNothingWaitsForIt) {
  ASSERT_EQ(::mkfifo(at("fifo").c_str(), 0600), 0);
  std::filesystem::create_directories(at("bag"));
  ASSERT_EQ(::mkfifo(at("bag/x.db3").c_str(), 0600), 0);
  const std::string plain = log("plain.csv", [](double, Row&) {});
  const auto import = [&](const std::vector<std::string>& logs) {
    std::vector<std::string> arguments = logs;
    arguments.insert(arguments.end(), {"--out", at("imported"), "--assume"});
    return test::run("import", arguments, {.wrapper = {"timeout", "20"}});
  };
  const char* words = "is not a regular file";
  expect_line(import({at("fifo")}), 3, words);
  expect_line(import({at("bag")}), 3, words);
  expect_line(import({plain, at("fifo")}), 3, words);
  EXPECT_FALSE(std::filesystem::exists(at("imported/plain.csv")));
}

TEST_F(HostileInputs, ASectionOfAConfigurationThatIsNoneIsNamed) {
  const std::string plain = log("a.csv", [](double, Row&) {});
  for (const std::string section : {"features", "map", "model", "training", "noise"}) {
    write_file(at("c.json"), "{\"" + section + "\": 5}");
    expect_line(test::run("train", {"--config", at("c.json"), "--train", plain, "--online",
                                    "--epochs", "1", "--out", at("m.dcnn")}),
                2, "c.json: key '" + section + "' must be an object, not 5");
  }
}

TEST_F(HostileInputs, ASimulatorBeyondPhysicsIsRefused) {
  const std::string plain = log("a.csv", [](double, Row&) {});
  const auto simulate = [&](const std::string& simulator) {
    write_file(at("s.json"), simulator);
    return test::run("sim", {"--sim", at("s.json"), "--motion", plain, "--out", at("s.csv")});
  };
  const std::string tool = R"({"tool": {"mass_kg": 0.6)";
  expect_line(simulate(tool + R"(}, "gravity_mps2": [0, 0, -1e308]})"), 3,
              "s.json: key 'gravity_mps2' must hold numbers between -1000 and 1000");
  expect_line(simulate(tool + R"(, "com_m": [1e300, 0, 0]}})"), 3, "key 'tool.com_m'");
  expect_line(simulate(R"({"tool": {"mass_kg": 1e300}})"), 3, "key 'tool.mass_kg'");
  expect_line(simulate(tool + R"(}, "sensor": {"rotation_rpy": [0, 0, 1e9]}})"), 3,
              "key 'sensor.rotation_rpy'");
  EXPECT_EQ(simulate(tool + "}}").exit_code, 0);
}

TEST_F(HostileInputs, NoNumberOfThreadsBreaksACommand) {
  const std::string plain = log("a.csv", [](double, Row&) {});
  ASSERT_EQ(test::run("train", {"--train", plain, "--model", "mlp", "--preset", "quick", "--epochs",
                                "1", "--out", at("m.dcnn")})
                .exit_code,
            0);
  const auto predict = [&](const std::string& threads, const std::string& memory) {
    return test::run(
        "predict", {at("m.dcnn"), "--data", plain, "--out", "-"},
        {.environment = {"OMP_NUM_THREADS=" + threads}, .wrapper = {"prlimit", "--as=" + memory}});
  };
  const std::string right = predict("1", "unlimited").out;
  EXPECT_EQ(predict("100000", "unlimited").out, right);
  int enough = 0;
  for (const char* threads : {"2", "64"}) {
    for (const char* memory : {"40000000", "60000000", "100000000", "300000000"}) {
      // Libraries that do not even load say so themselves.
      const auto loaded = test::run("predict", {"--version"},
                                    {.wrapper = {"prlimit", std::string("--as=") + memory}});
      if (loaded.exit_code != 0) continue;
      const auto result = predict(threads, memory);
      EXPECT_EQ(result.err.find("libgomp"), std::string::npos) << result.err;
      EXPECT_LE(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
      if (result.exit_code == 0) {
        EXPECT_EQ(result.out, right);
      }
      enough += result.exit_code == 0;
    }
  }
  EXPECT_GT(enough, 0);
}

TEST_F(HostileInputs, ATemporaryFolderThatIsNoneIsOneLineWhereItIsUsed) {
  const auto sweep = [&](const std::vector<std::string>& arguments) {
    return test::run("sweep", arguments, {.environment = {"TMPDIR=/nonexistent"}});
  };
  EXPECT_EQ(sweep({"--help"}).exit_code, 0);
  expect_line(sweep({"--plan", at("p"), "--jobs", "1"}), 2, "--scratch DIR");
}

}  // namespace
}  // namespace dcnn
