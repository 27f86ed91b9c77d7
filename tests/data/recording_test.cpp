// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iomanip>
#include <numbers>
#include <sstream>

#include "data/sample_recording.h"
#include "data/testing.h"
#include "dcnn/core/random.h"

namespace dcnn {
namespace {

using testing::contains;
using testing::error_of;
using testing::temporary_file;

/// 100 rows at 500 Hz; `edit` changes one row (t, x,y,z, alpha,beta,gamma, fx,fy,fz).
std::string log_text(const std::function<void(Index, std::vector<double>&)>& edit = {}) {
  std::ostringstream out;
  out << std::setprecision(17) << "t,x,y,z,alpha,beta,gamma,fx,fy,fz\n";
  for (Index i = 0; i < 100; ++i) {
    const double t = 0.002 * static_cast<double>(i);
    std::vector<double> row = {t, 0.1 * t, 0.2, 0.3, 0.1, 0.2, 3.1 + 0.5 * t, 1.0, 2.0, t};
    if (edit) edit(i, row);
    for (std::size_t k = 0; k < row.size(); ++k) out << (k ? "," : "") << row[k];
    out << "\n";
  }
  return out.str();
}

Recording read(const std::string& text, const ReadOptions& options = {},
               const System& system = {}) {
  return read_recording(temporary_file("log.csv", text), options, system);
}

void expect_error(const std::string& text, const std::vector<std::string>& fragments,
                  const ReadOptions& options = {}) {
  const std::string message = error_of([&] { read(text, options); }, Exit::kData);
  for (const std::string& part : fragments) EXPECT_TRUE(contains(message, part)) << message;
  EXPECT_FALSE(contains(message, "\n"));
}

bool noted(const Recording& recording, const std::string& part) {
  for (const std::string& note : recording.notes) {
    if (contains(note, part)) return true;
  }
  return false;
}

TEST(Recording, KeepsAPlainLogAsItIs) {
  const Recording recording = read(log_text());
  EXPECT_EQ(recording.name, "log.csv");
  EXPECT_EQ(recording.samples(), 100);
  EXPECT_NEAR(recording.dt, 0.002, 1e-12);
  EXPECT_EQ(recording.segments.size(), 1u);
  EXPECT_TRUE(recording.notes.empty());
}

TEST(Recording, NamesTheMissingColumn) {
  expect_error("t,fx,fy,fz\n0,1,2,3\n", {":1:", "no orientation", "alpha,beta,gamma"});
  expect_error("t,alpha,gamma,fx,fy,fz\n0,1,1,1,2,3\n", {":1:", "'beta'"});
  expect_error("t,alpha,beta,gamma\n0,1,1,1\n", {":1:", "no measured force"});
  expect_error("t,alpha,beta,gamma,fx,fz\n0,1,1,1,1,1\n", {":1:", "'fy'"});
  expect_error("alpha,beta,gamma,fx,fy,fz\n1,1,1,1,1,1\n", {":1:", "'t'", "seconds"});
}

TEST(Recording, NamesAColumnThatIsKnownUnderAnotherSpelling) {
  const std::string header = "t,x,y,z,alpha,beta,gamma,fx,fy,fz\n", text = log_text();
  const std::string rows = text.substr(header.size());
  const auto refused = [&](const std::string& columns, const std::string& found,
                           const std::string& meant) {
    expect_error(columns + "\n" + rows, {":1: column '" + found + "': did you mean " + meant +
                                             "? read the log with dcnn-import",
                                         "rename it, if it is in SI units"});
  };
  refused("time,x,y,z,alpha,beta,gamma,fx,fy,fz", "time", "t");
  refused("Timestamp [s],x,y,z,alpha,beta,gamma,fx,fy,fz", "Timestamp [s]", "t");
  refused("t,x,y,z,alpha,beta,gamma,Fx,Fy,Fz", "Fx", "fx");
  refused("t,x,y,z,Alpha,beta,gamma,fx,fy,fz", "Alpha", "alpha");
  refused("t,x,y,z,alpha,beta,gamma,f_x (N),fy,fz", "f_x (N)", "fx");
  EXPECT_NO_THROW(read("time," + header + [&] {  // what is meant is there, too
    std::string twice;
    std::istringstream lines(rows);
    for (std::string line; std::getline(lines, line);)
      twice += line.substr(0, line.find(',')) + "," + line + "\n";
    return twice;
  }()));
}

TEST(Recording, RejectsTimeThatRepeatsOrGoesBack) {
  expect_error(log_text([](Index i, auto& row) {
                 if (i == 40) row[0] = 0.078;
               }),
               {"log.csv:42:", "repeats", "remove"});
  expect_error(log_text([](Index i, auto& row) {
                 if (i >= 40) row[0] -= 1.0;
               }),
               {"log.csv:42:", "increase", "cut"});
  expect_error(log_text([](Index, auto& row) { row[0] *= 1e9; }), {"'t'", "seconds"});
}

TEST(Recording, MovesTheOriginOfAnEpochClock) {
  const Recording recording = read(log_text([](Index, auto& row) { row[0] += 1.7e9; }));
  EXPECT_EQ(recording.clock_origin, 1.7e9);
  EXPECT_EQ(recording.column("t")[0], 0.0);
  EXPECT_NEAR(recording.dt, 0.002, 1e-6);
}

TEST(Recording, SplitsAtAGap) {
  const Recording recording = read(log_text([](Index i, auto& row) {
    if (i >= 60) row[0] += 1.0;
  }));
  ASSERT_EQ(recording.segments.size(), 2u);
  EXPECT_EQ(recording.segments[0].end, 60);
  EXPECT_EQ(recording.segments[1].begin, 60);
  EXPECT_EQ(recording.segments[1].end, 100);
  EXPECT_TRUE(noted(recording, "gap"));
}

// Four lost rows are a step of exactly five, which no rounding of stamps makes a gap.
TEST(Recording, BridgesFourLostRows) {
  const Recording recording = read(log_text([](Index i, auto& row) {
    if (i >= 60) row[0] = std::round(1e6 * (row[0] + 0.008 + 1e-6)) / 1e6;
  }));
  ASSERT_EQ(recording.segments.size(), 1u);
  EXPECT_TRUE(noted(recording, "4 rows are lost"));
}

TEST(Recording, LeavesOutTwoRowsBetweenGaps) {
  const Recording recording = read(log_text([](Index i, auto& row) {
    if (i >= 60) row[0] += 1.0;
    if (i >= 62) row[0] += 1.0;
  }));
  ASSERT_EQ(recording.segments.size(), 2u);
  EXPECT_EQ(recording.samples(), 98);
  EXPECT_EQ(recording.segments[1].begin, 60);
  EXPECT_EQ(recording.segments[1].end, 98);
  EXPECT_NEAR(recording.column("t")[60], 62 * 0.002 + 2.0, 1e-9);
  EXPECT_TRUE(noted(recording, "2 rows"));
}

std::string irregular_text() {
  return log_text([](Index i, auto& row) {
    if (i % 10 == 5) row[0] += 0.001;
    row[1] = 0.1 * row[0];
    row[6] = 3.1 + 0.5 * row[0];
    row[9] = row[0];
  });
}

/// A log of `rows` rows at 500 Hz that loses every hundredth, its stamps off by up to `jitter`
/// steps.
std::string jittered_text(Index rows, double jitter) {
  std::ostringstream out;
  out << std::setprecision(12) << "t,x,y,z,alpha,beta,gamma,fx,fy,fz\n";
  Rng rng({7});
  for (Index i = 0; i < rows; ++i) {
    const double off = jitter * (2.0 * rng.uniform() - 1.0);
    if (i % 100 == 99) continue;
    out << 0.002 * (static_cast<double>(i) + off) << ",0,0,0,0,0,3,0,0,0\n";
  }
  return out.str();
}

TEST(Recording, CountsTheStepOfAClockWhoseStampsJitter) {
  const double jitter = 0.08;
  const Index rows = 20'000;
  // The ends alone err by two jitters; the median step of these stamps is off by 4e-4 of it.
  const double most = 2.0 * jitter / double(rows);
  EXPECT_NEAR(read(jittered_text(rows, jitter)).dt / 0.002, 1.0, most);
  EXPECT_NEAR(read(jittered_text(rows, 0.0)).dt, 0.002, 1e-12);
}

TEST(Recording, RejectsAnIrregularClockAndNamesResample) {
  expect_error(irregular_text(), {"log.csv:7:", "irregular", "--resample"});
}

// The median of uneven steps is off by about a hundredth of their deviation; the mean is not.
TEST(Recording, ResamplesToTheMeanRate) {
  ReadOptions options;
  options.resample = true;
  const Recording recording = read(jittered_text(5000, 0.2), options);
  EXPECT_NEAR(500.0 * recording.dt, 1.0, 2e-5);
}

TEST(Recording, ResamplesLinearSignalsExactly) {
  for (const double hz : {0.0, 250.0, 800.0}) {
    ReadOptions options;
    options.resample = true;
    options.resample_hz = hz;
    const Recording recording = read(irregular_text(), options);
    EXPECT_NEAR(1.0 / recording.dt, hz > 0.0 ? hz : 500.0, 1e-6);
    const Eigen::VectorXd t = recording.column("t");
    EXPECT_LT((recording.column("x") - 0.1 * t).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((recording.column("fz") - t).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT(
        ((t.tail(t.size() - 1) - t.head(t.size() - 1)).array() - recording.dt).abs().maxCoeff(),
        1e-12);
    EXPECT_TRUE(noted(recording, "resampled"));
  }
}

// What linear interpolation makes of white noise, at half, once and three times the old rate.
TEST(Recording, KnowsTheSpectrumThatResamplingMakes) {
  Rng rng({12});
  std::ostringstream text;
  text << "t,x,y,z,alpha,beta,gamma,fx,fy,fz\n";
  for (int i = 0; i < 10'000; ++i) {
    text << 0.002 * (i + 0.4 * rng.uniform(-1.0, 1.0)) << ",0,0,0,0,0,3,0,0," << rng.normal()
         << "\n";
  }
  for (const double hz : {250.0, 500.0, 1500.0}) {
    ReadOptions options;
    options.resample = true;
    options.resample_hz = hz;
    const Recording recording = read(text.str(), options);
    ASSERT_GE(recording.interpolated.size(), 3U);
    const Eigen::VectorXd x = recording.column("fz");
    double slow = 0.0;  // power at 0 Hz, where old rows count by the time about them
    for (std::size_t lag = 0; lag < recording.interpolated.size(); ++lag) {
      const Index n = x.size() - static_cast<Index>(lag);
      const double seen = x.head(n).dot(x.tail(n)) / static_cast<double>(n);
      EXPECT_NEAR(recording.interpolated[lag], seen, 0.05) << hz << " Hz, lag " << lag;
      slow += (lag == 0 ? 1.0 : 2.0) * recording.interpolated[lag];
    }
    if (hz >= 500.0) {
      EXPECT_NEAR(slow / (hz / 500.0), 1.03, 0.03) << hz;
    }
  }
}

// Rows that come in bursts: what is a gap of theirs is a row or two of a slower clock.
TEST(Recording, ResamplesBurstsToOneSlowerClock) {
  const auto text = log_text([](Index i, auto& row) {
    row[0] += 0.03 * static_cast<double>(i / 5);
    row[1] = 0.1 * row[0];
  });
  ReadOptions options;
  options.resample = true;
  options.resample_hz = 50.0;
  const Recording recording = read(text, options);
  EXPECT_EQ(recording.segments.size(), 1u);
  EXPECT_TRUE(noted(recording, "bridged"));
  const Eigen::VectorXd t = recording.column("t");
  EXPECT_LT((recording.column("x") - 0.1 * t).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(((t.tail(t.size() - 1) - t.head(t.size() - 1)).array() - 0.02).abs().maxCoeff(), 1e-12);
}

TEST(Recording, ResamplesAnglesAcrossTheBranch) {
  const auto text = log_text([](Index i, auto& row) {
    if (i % 10 == 5) row[0] += 0.001;
    row[6] = 3.1 + 0.5 * row[0];
    if (row[6] > std::numbers::pi) row[6] -= 2.0 * std::numbers::pi;
  });
  ReadOptions options;
  options.resample = true;
  const Recording recording = read(text, options);
  const Eigen::VectorXd wanted = (0.5 * recording.column("t")).array() + 3.1;
  EXPECT_LT((recording.column("gamma") - wanted).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Recording, NamesDegreesAndMillimetres) {
  expect_error(log_text([](Index, auto& row) { row[6] = 180.0; }),
               {":2:", "'gamma'", "--angle-unit deg"});
  expect_error(log_text([](Index i, auto& row) {
                 if (i == 9) row[5] = -35.0;
               }),
               {":11:", "'beta'", "--angle-unit deg"});
  expect_error(log_text([](Index, auto& row) { row[2] = 350.0; }),
               {":2:", "'y'", "--position-unit mm"});
  expect_error(log_text([](Index, auto& row) { row[1] = 60.0 * row[0]; }),
               {"speed", "--position-unit mm"});
}

TEST(Recording, ConvertsUnitsAndSaysSo) {
  ReadOptions options;
  options.position_unit = 0.001;
  options.angle_unit = std::numbers::pi / 180.0;
  options.force_sign = -1.0;
  const auto text = log_text([](Index, auto& row) {
    for (int k = 1; k <= 3; ++k) row[static_cast<std::size_t>(k)] *= 1000.0;
    for (int k = 4; k <= 6; ++k) row[static_cast<std::size_t>(k)] *= 180.0 / std::numbers::pi;
  });
  const Recording recording = read(text, options), plain = read(log_text());
  const std::vector<std::string> pose = {"x", "y", "z", "alpha", "beta", "gamma"};
  EXPECT_LT((recording.block(pose) - plain.block(pose)).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(recording.column("fx"), -plain.column("fx"));
  EXPECT_EQ(recording.notes.size(), 3u);
}

TEST(Recording, OfPosesWithTheirTimesHasNoClockBetweenThem) {
  ReadOptions options;
  options.static_list = true;
  const std::string head = "t,alpha,beta,gamma,fx,fy,fz\n";
  const std::string poses = "0,0,0,1,1,2,3\n9,1,0.5,2,1,2,3\n21,-1,0.2,3,1,2,3\n2000,2,0,1,1,2,3\n";
  const Recording recording = read(head + poses, options);
  EXPECT_EQ(recording.dt, 0.0);
  ASSERT_EQ(recording.segments.size(), 1u);
  EXPECT_EQ(recording.column("t")[3], 2000.0);
  std::string motion = head;  // 250 Hz, its clock in milliseconds
  for (int i = 0; i < 300; ++i) {
    const std::string angle = std::to_string(std::sin(0.02 * i));
    motion += std::to_string(4 * i) + "," + angle + ",0,1,1,2,3\n";
  }
  expect_error(motion, {"write t in seconds"}, options);
}

/// seconds make a clock, but a remedy for clocks is none for them.
TEST(Recording, OfJointsAtRestHasNoTimes) {
  const System system = parse_system(
      Json::parse(
          R"({"kind":"axes","axes":[{"name":"a","measured":"tau","unit":"N*m","position":"q"}]})"),
      "s.json");
  ReadOptions lists;
  lists.static_list = true;
  const std::string text = "q,tau\n0,1\n1,2\n-1,3\n";
  EXPECT_EQ(read(text, lists, system).dt, 0.0);
  const auto refused = [&](const std::string& log, const ReadOptions& options) {
    return error_of([&] { read(log, options, system); }, Exit::kData);
  };
  const std::string untimed = refused(text, {});
  EXPECT_TRUE(contains(untimed, "log the time in seconds")) << untimed;
  EXPECT_FALSE(contains(untimed, "only lists")) << untimed;
  const std::string timed = refused("t,q,tau\n0,0,1\n9,1,2\n21,-1,3\n60,2,1\n", lists);
  EXPECT_TRUE(contains(timed, "leave column 't' out of a list of poses at rest")) << timed;
}

TEST(Recording, RenormalisesQuaternionsAndRejectsBadOnes) {
  const std::string head = "qw,qx,qy,qz,fx,fy,fz\n0.5,0.5,0.5,0.5,1,2,3\n";
  ReadOptions options;
  options.static_list = true;
  const Recording recording = read(head + "1.0005,0,0,0,1,2,3\n", options);
  EXPECT_EQ(recording.dt, 0.0);
  EXPECT_EQ(recording.column("qw")[1], 1.0);
  expect_error(head + "1.002,0,0,0,1,2,3\n", {":3:", "1.002"}, options);
  expect_error(head + "0,0,0,0,1,2,3\n", {":3:", "quaternion"}, options);
  expect_error(head, {"'t'"});
}

TEST(Recording, ReadsTheAxesOfASystem) {
  const System system = parse_system(
      Json::parse(
          R"({"kind":"axes","axes":[{"name":"a","measured":"tau","unit":"N*m","position":"q","scale":2}]})"),
      "s.json");
  const std::string text = "t,q,tau\n0,1000,1\n0.1,2000,2\n0.2,-3000,3\n";
  const Recording recording = read(text, {}, system);
  const Targets targets = find_targets(recording, system);
  EXPECT_EQ(targets.names, std::vector<std::string>{"tau"});
  EXPECT_EQ(targets.units, std::vector<std::string>{"N*m"});
  EXPECT_EQ(measured(recording, targets, system)(2, 0), 6.0);
  const std::string message = error_of([&] { read("t,q\n0,1\n1,2\n", {}, system); }, Exit::kData);
  EXPECT_TRUE(contains(message, "'tau' of axis 'a'")) << message;
}

TEST(System, RejectsWhatItDoesNotKnow) {
  const auto message = [](const char* text) {
    return error_of([&] { parse_system(Json::parse(text), "s.json"); }, Exit::kData);
  };
  EXPECT_TRUE(contains(message(R"({"kind":"axis"})"), "wrist, axes"));
  EXPECT_TRUE(contains(message(R"({"lowpas_hz":3})"), "lowpass_hz"));
  EXPECT_TRUE(contains(message(R"({"kind":"axes"})"), "'axes'"));
  EXPECT_TRUE(
      contains(message(R"({"kind":"axes","axes":[{"name":"a"}]})"), "'measured' is missing"));
  EXPECT_TRUE(
      contains(message(R"({"kind":"axes","axes":[{"name":"a","measured":"m","postion":"q"}]})"),
               "position"));
  EXPECT_TRUE(contains(
      message(
          R"({"kind":"axes","axes":[{"name":"a","measured":"m"},{"name":"a","measured":"n"}]})"),
      "twice"));
}

TEST(System, TellsAnEmptyBaseFromNone) {
  const auto axis = [](const char* text) {
    return parse_system(Json::parse(text), "s.json").axes[0];
  };
  EXPECT_TRUE(axis(R"({"kind":"axes","axes":[{"name":"a","measured":"m","base":[]}]})").has_base);
  EXPECT_FALSE(axis(R"({"kind":"axes","axes":[{"name":"a","measured":"m"}]})").has_base);
  const char* of_an_arm =
      R"({"kind":"axes","axes":[{"name":"a","measured":"m","base":[]}],"arm":{}})";
  EXPECT_FALSE(axis(of_an_arm).has_base) << "the arm's bodies are its simulator";
}

}  // namespace
}  // namespace dcnn
