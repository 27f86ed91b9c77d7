// SPDX-License-Identifier: Apache-2.0
// dcnn.h from C and from Python gives what dcnn-run gives, and exports nothing else.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/data/csv.h"
#include "dcnn/data/rotation.h"
#include "support/process.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

const std::string kSim = DCNN_SOURCE_DIR "/data/sample/sim.json";
const std::string kLibrary = DCNN_BINARY_DIR "/lib/libdcnn.so.0";

/// What a shell command prints; its exit code.
std::pair<std::string, int> shell(const std::string& command) {
  FILE* pipe = ::popen(command.c_str(), "r");
  std::string text;
  for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  return {text, WEXITSTATUS(::pclose(pipe))};
}

Eigen::VectorXd column(const Table& table, const std::string& name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  return table.values.col(found - table.columns.begin());
}

/// The first rows of the sample, as lines of "t x y z qw qx qy qz fx fy fz" and as dcnn-run's rows.
class CInterface : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::kSanitized) GTEST_SKIP() << "a program of another compiler cannot load the library";
    Table table = read_csv(DCNN_SOURCE_DIR "/data/sample/test.csv");
    table.values.conservativeResize(kRows, Eigen::NoChange);
    for (const char* torque : {"tx", "ty", "tz"}) {  // the examples give forces alone
      const auto found = std::find(table.columns.begin(), table.columns.end(), torque);
      table.values.col(found - table.columns.begin()).setZero();
    }
    write_csv(log_, table);
    std::ofstream lines(samples_);
    lines.precision(17);
    for (Eigen::Index k = 0; k < kRows; ++k) {
      const auto at = [&](const char* name) { return column(table, name)[k]; };
      const Eigen::Quaterniond q(rotation_from_euler({at("alpha"), at("beta"), at("gamma")}));
      lines << at("t") << " " << at("x") << " " << at("y") << " " << at("z") << " " << q.w() << " "
            << q.x() << " " << q.y() << " " << q.z() << " " << at("fx") << " " << at("fy") << " "
            << at("fz") << "\n";
    }
  }

  /// Rows "t STATE fx fy fz" beside the answers of dcnn-run --stdin; STATE may be a dash.
  void expect_as_online(const std::string& text) {
    const auto online = test::Process("run", {"--model", kSim, "--stdin"}, {.input = log_}).wait();
    ASSERT_EQ(online.exit_code, 0) << online.err;
    std::istringstream rows(text), answers(online.out);
    std::string header;
    std::getline(answers, header);
    ASSERT_TRUE(header.starts_with("t,fx_ext,fy_ext,fz_ext")) << header;
    int count = 0;
    for (double t, x, y, z; ++count <= kRows;) {
      std::string state, answer;
      ASSERT_TRUE(rows >> t >> state >> x >> y >> z) << count;
      std::getline(answers, answer);
      std::replace(answer.begin(), answer.end(), ',', ' ');
      std::istringstream numbers(answer);
      double at = 0.0, fx = 0.0, fy = 0.0, fz = 0.0;
      numbers >> at >> fx >> fy >> fz;
      EXPECT_NEAR(std::hypot(x - fx, y - fy, z - fz), 0.0, 1e-5) << "row " << count;
      EXPECT_TRUE(state == "-" || answer.find(state) != answer.npos) << answer;
    }
  }

  static constexpr int kRows = 300;
  test::TemporaryFolder folder_;
  std::string log_ = folder_ / "log.csv", samples_ = folder_ / "samples.txt",
              program_ = folder_ / "predict";
};

TEST_F(CInterface, OfC90GivesWhatRunsOnline) {
  const auto [built, code] =
      shell("cc -std=c90 -pedantic -Wall -Wextra -Werror -Wno-long-long -I" DCNN_SOURCE_DIR
            "/include " DCNN_SOURCE_DIR "/examples/predict.c " +
            kLibrary + " -o " + program_ + " 2>&1");
  ASSERT_EQ(code, 0) << built;
  const std::string run = "LD_LIBRARY_PATH=" DCNN_BINARY_DIR "/lib " + program_ + " ";
  expect_as_online(shell(run + kSim + " < " + samples_).first);
  const auto [error, refused] = shell(run + "none.dcnn 2>&1 < /dev/null");
  EXPECT_EQ(refused, 1);
  EXPECT_NE(error.find("none.dcnn"), error.npos) << error;
}

/// The header's words on texts, files, `error` and NULL.
TEST_F(CInterface, KeepsWhatItsHeaderPromises) {
  std::ofstream(folder_ / "promises.c") << R"(
#include <stdio.h>
#include <string.h>
#include "dcnn.h"
int main(int argc, char** argv) {
  char error[64] = "as it was";
  const double zero[3] = {0, 0, 0}, unturned[4] = {1, 0, 0, 0};
  const char *reason, *state;
  dcnn_tool* tool = dcnn_open(argv[argc - 1], NULL, NULL, error, sizeof error);
  if (!tool || strcmp(error, "as it was") != 0) return 1;
  if (remove(argv[argc - 1]) != 0) return 2;
  if (dcnn_step(tool, 0, zero, unturned, NULL, NULL, NULL) < 0) return 3;
  reason = dcnn_reason(tool);
  state = dcnn_state_name(DCNN_PHYSICS);
  dcnn_close(tool);
  if (strlen(reason) == 0 || strcmp(state, "PHYSICS") != 0) return 4;
  if (dcnn_miss(NULL, NULL) != -1 || strcmp(dcnn_reason(NULL), "none") != 0) return 5;
  return dcnn_sample_time(NULL) != 0.0 || dcnn_contact(NULL) || dcnn_has_torque(NULL) ? 6 : 0;
}
)";
  const std::string model = folder_ / "gone.json";
  std::filesystem::copy_file(kSim, model);
  const auto [text, code] =
      shell("cc -std=c90 -I" DCNN_SOURCE_DIR "/include " + (folder_ / "promises.c").string() + " " +
            kLibrary + " -o " + program_ + " 2>&1 && LD_LIBRARY_PATH=" DCNN_BINARY_DIR "/lib " +
            program_ + " " + model);
  EXPECT_EQ(code, 0) << text;
}

TEST_F(CInterface, OfPythonGivesWhatRunsOnline) {
  if (shell("/usr/bin/python3 -c 'import numpy' 2>&1").second != 0) GTEST_SKIP() << "no numpy here";
  expect_as_online(shell("/usr/bin/python3 " DCNN_SOURCE_DIR "/examples/predict.py " + kLibrary +
                         " " + kSim + " < " + samples_)
                       .first);
}

/// Octave, with a loadlibrary and a calllib that take of a header what MATLAB's take, runs the
/// example for MATLAB.
class CInterfaceOfMatlab : public CInterface {
 protected:
  void SetUp() override {
    CInterface::SetUp();
    if (IsSkipped()) return;
    if (shell("command -v octave-cli mkoctfile").second != 0)
      GTEST_SKIP() << "octave and octave-dev are not installed here";
    const auto [built, code] =
        shell("cd " + folder_.path().string() +
              " && mkoctfile --mex -I" DCNN_SOURCE_DIR "/include -o dcnn_call.mex " DCNN_SOURCE_DIR
              "/tests/support/matlab/dcnn_call.c 2>&1");
    ASSERT_EQ(code, 0) << built;
  }

  std::pair<std::string, int> octave(const std::string& script) {
    std::ofstream(folder_ / "run.m") << script << "\n";
    return shell("cd " + folder_.path().string() +
                 " && octave-cli --no-gui --norc --path " DCNN_SOURCE_DIR
                 "/tests/support/matlab --path " DCNN_SOURCE_DIR "/examples --path . run.m 2>&1");
  }
};

TEST_F(CInterfaceOfMatlab, GivesWhatRunsOnline) {
  const auto [text, code] = octave(
      "samples = load('" + samples_ + "'); external = predict('" + kSim + "', samples, '" +
      kLibrary +
      "', '" DCNN_SOURCE_DIR
      "/include/dcnn.h'); printf('%.17g - %.17g %.17g %.17g\\n', [samples(:, 1) external]');");
  ASSERT_EQ(code, 0) << text;
  expect_as_online(text);
}

TEST_F(CInterfaceOfMatlab, RefusesAHeaderThatMatlabCannotRead) {
  std::ofstream(folder_ / "odd.h")
      << "typedef struct dcnn_tool dcnn_tool; int dcnn_step(dcnn_tool* handle, long double x);";
  const auto [text, code] = octave("loadlibrary('" + kLibrary + "', 'odd.h', 'alias', 'dcnn');");
  EXPECT_NE(code, 0);
  EXPECT_NE(text.find("MATLAB has no type for 'long double'"), text.npos) << text;
}

TEST(CLibrary, HasTheRecordedInterface) {
  if (shell("command -v abidiff").second != 0)
    GTEST_SKIP() << "abigail-tools are not installed here";
  const test::TemporaryFolder folder;
  const std::string now = folder / "now.abi", tool = DCNN_SOURCE_DIR "/tools/support/interface ";
  ASSERT_EQ(shell(tool + kLibrary + " > " + now).second, 0);
  const auto [changes, code] = shell("abidiff " DCNN_SOURCE_DIR "/c/dcnn.abi " + now + " 2>&1");
  EXPECT_EQ(code, 0) << changes << "\nif only functions were added: tools/package --abi";
}

TEST(CLibrary, ExportsItsVersionedSymbolsAlone) {
  std::istringstream names(shell("nm -D --defined-only --format=posix " + kLibrary).first);
  int count = 0;
  for (std::string line; std::getline(names, line); ++count) {
    EXPECT_TRUE(line.starts_with("dcnn_") || line.starts_with("DCNN_0 ")) << line;
  }
  EXPECT_GE(count, 12);
}

}  // namespace
}  // namespace dcnn
