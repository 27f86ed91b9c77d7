// SPDX-License-Identifier: Apache-2.0
// dcnn-diagnose on anything: whatever the recordings are, a verdict or one line, in bounded time
// and memory, and no confident name for a channel that is dead. DCNN_ANY_CASES and DCNN_ANY_SEED
// make a longer run (tools/fuzz).
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "dcnn/core/file.h"
#include "dcnn/core/parallel.h"
#include "dcnn/experiment/diagnosis_report.h"
#include "support/process.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

constexpr int kCases = 30;
constexpr int kMostRows = 1500;           // of all recordings of a case together
constexpr rlim_t kMostSeconds = 60;       // of processor time for one case
constexpr rlim_t kMostMemory = 3U << 30;  // bytes

enum class Fault { kNone, kConstant, kZero, kClipped, kTwoLevels, kHuge, kTiny };
enum class Clock { kRegular, kIrregular, kGap, kStatic, kLost };
constexpr const char* kFaults[] = {"none",       "constant", "zero", "clipped",
                                   "two levels", "huge",     "tiny"};
constexpr const char* kClocks[] = {"regular", "irregular", "gap", "static", "lost rows"};

/// One drawn situation; all that is random follows from the seed.
struct Situation {
  explicit Situation(unsigned seed) : random(seed) {
    rows = one_of({1, 3, 8, 15, 30, 60, 150, 300, 400, 700, 1000, 1400});
    hz = one_of({1.0, 2.0, 10.0, 60.0, 500.0, 2000.0, 10000.0});
    recordings = std::min(one_of({1, 1, 2, 3, 7, 50}), std::max(1, kMostRows / rows));
    holdouts = one_of({0, 1, 2});
    fault = Fault(one_of({0, 0, 1, 2, 3, 4, 5, 6}));
    clock = Clock(one_of({0, 0, 0, 1, 2, 3, 4}));
    torque = one_of({false, true});
    columns = one_of({false, false, true});
    moves = one_of({true, true, true, false});
    channel = one_of({"fx", "fz", "fy", torque ? "tx" : "fx", "x", "alpha", "beta"});
    if (fault == Fault::kHuge && channel[0] != 'f') channel = "fy";
    everywhere = one_of({true, true, false});
    noise = one_of({0.0, 1e-4, 0.04, 1.0});
  }

  template <class T>
  T one_of(std::initializer_list<T> list) {
    return list.begin()[random() % list.size()];
  }

  std::string words() const {
    std::ostringstream out;
    out << recordings << " recordings of " << rows << " rows at " << hz << " Hz ("
        << kClocks[int(clock)] << "), " << holdouts << " held out, "
        << (torque ? "with torque" : "forces alone") << (columns ? ", *_sim columns" : "")
        << (moves ? "" : ", motionless") << ", noise " << noise << ", " << channel << " "
        << kFaults[int(fault)] << (everywhere ? "" : " in one of them");
    return out.str();
  }

  bool dead_force() const {
    return (fault == Fault::kConstant || fault == Fault::kZero) &&
           (channel[0] == 'f' || channel[0] == 't');
  }

  std::mt19937 random;
  int rows, recordings, holdouts;
  double hz;
  Fault fault;
  Clock clock;
  bool torque, columns, moves, everywhere;
  std::string channel;
  double noise;
};

std::vector<double> clock_of(Situation& s, double start) {
  std::vector<double> t;
  for (int i = 0; i < s.rows; ++i) {
    double step = 1.0 / s.hz;
    if (s.clock == Clock::kIrregular) step *= 0.5 + double(s.random() % 1000) / 1000.0;
    if (s.clock == Clock::kGap && i == s.rows / 2) step *= 1e7;
    if (s.clock == Clock::kLost && s.random() % 20 == 0) step *= 2.0;
    t.push_back(i == 0 ? start : t.back() + step);
  }
  return t;
}

void spoil(std::vector<double>& x, Fault fault) {
  const double most = *std::max_element(x.begin(), x.end()),
               least = *std::min_element(x.begin(), x.end());
  for (double& v : x) {
    switch (fault) {
      case Fault::kNone:
        break;
      case Fault::kConstant:
        v = x.front();
        break;
      case Fault::kZero:
        v = 0.0;
        break;
      case Fault::kClipped:
        v = std::clamp(v, 0.7 * least + 0.3 * most, 0.3 * least + 0.7 * most);
        break;
      case Fault::kTwoLevels:
        v = v > 0.5 * (least + most) ? most : least;
        break;
      case Fault::kHuge:
        v *= 1e8;
        break;
      case Fault::kTiny:
        v *= 1e-9;
        break;
    }
  }
}

/// A point mass on a wrist that swings slowly; inertia is left to the simulator.
void write_recording(Situation& s, const std::filesystem::path& path, double start, bool spoiled) {
  const std::vector<double> t = clock_of(s, start);
  std::map<std::string, std::vector<double>> columns;
  std::normal_distribution<double> normal;
  const double step = s.moves ? 1.0 : 0.0;
  for (const double at : t) {
    const double a = 0.9 * std::sin(0.7 * at) * step, b = 0.6 * std::sin(1.1 * at + 1.0) * step,
                 c = 3.0 + 0.5 * std::sin(0.9 * at + 2.0) * step, g = 0.75 * 9.81;
    const double force[3] = {g * std::sin(b), -g * std::cos(b) * std::sin(c),
                             -g * std::cos(b) * std::cos(c)};
    columns["alpha"].push_back(a), columns["beta"].push_back(b), columns["gamma"].push_back(c);
    columns["x"].push_back(0.1 * std::sin(0.8 * at) * step),
        columns["y"].push_back(0.1 * std::cos(0.6 * at) * step);
    columns["z"].push_back(0.3 + 0.1 * std::sin(1.3 * at) * step);
    for (int k = 0; k < 3; ++k) {
      const std::string force_name = std::string("f") + "xyz"[k],
                        torque_name = std::string("t") + "xyz"[k];
      columns[force_name].push_back(force[k] + s.noise * normal(s.random));
      if (s.columns) columns[force_name + "_sim"].push_back(force[k]);
      const double torque = k == 0 ? -0.16 * force[1] : k == 1 ? 0.16 * force[0] : 0.0;
      if (s.torque) columns[torque_name].push_back(torque + 0.05 * s.noise * normal(s.random));
      if (s.torque && s.columns) columns[torque_name + "_sim"].push_back(torque);
    }
  }
  if (s.clock != Clock::kStatic) columns["t"] = t;
  if (spoiled) spoil(columns[s.channel], s.fault);
  std::ostringstream text;
  text.precision(12);
  const char* comma = "";
  for (const auto& [name, values] : columns) text << std::exchange(comma, ",") << name;
  for (std::size_t i = 0; i < t.size(); ++i) {
    comma = "\n";
    for (const auto& [name, values] : columns) text << std::exchange(comma, ",") << values[i];
  }
  write_file(path, text.str() + "\n");
}

DiagnosisRequest written(Situation& s, const test::TemporaryFolder& folder) {
  DiagnosisRequest request;
  double start = 0.0;
  for (int k = 0; k < s.recordings + s.holdouts; ++k) {
    const auto path = folder / ("r" + std::to_string(k) + ".csv");
    write_recording(s, path, start, s.everywhere || k == 0);
    (k < s.recordings ? request.fit : request.holdout).push_back(path);
    start += (s.rows + 10) / s.hz * (s.clock == Clock::kGap ? 1e8 : 3.0);
  }
  request.read.resample = s.clock == Clock::kIrregular;
  if (s.channel != "fz") request.read.resample_hz = s.hz;  // else each at its own rate
  if (!s.columns) {
    Json sim{{"tool", {{"mass_kg", 0.75}, {"com_m", {0.0, 0.0, 0.16}}}}};
    if (s.torque) sim["tool"]["inertia_kgm2"] = {0.0192, 0.0192, 0.001, 0.0, 0.0, 0.0};
    write_file(folder / "sim.json", sim.dump());
    request.simulator = folder / "sim.json";
  }
  return request;
}

/// What is wrong with a report; empty where nothing is.
std::string fault_of(const Situation& s, const Diagnosis& diagnosis) {
  const Json& report = diagnosis.report;
  const std::string verdict = report["verdict"];
  if (verdict != "consistent" && verdict != "explained" && verdict != "partly-explained" &&
      verdict != "unexplained") {
    return "no verdict: " + verdict;
  }
  for (const char* none : {" nan", "-nan", "[nan", " inf", "-inf"}) {
    if (to_text(diagnosis).find(none) != std::string::npos)
      return "no number in the text: " + to_text(diagnosis);
  }
  for (const Json& f : report["findings"]) {
    for (const auto& [name, number] : f["parameters"].items()) {
      if (!number["value"].is_number()) return "a parameter that is no number: " + f.dump();
    }
    const bool confident = f["confidence"].is_number() && f["confidence"].get<double>() > 0.9;
    const std::string effect = f["effect"];
    if (s.dead_force() && s.moves && confident && effect != "gain" && effect != "bias") {
      return "a dead channel is called " + effect;
    }
  }
  return "";
}

/// What came of a case in a process of its own: a verdict, an error of one line, or a fault.
std::string outcome_of(unsigned seed) {
  Situation s(seed);
  const test::TemporaryFolder folder;
  const DiagnosisRequest request = written(s, folder);
  const auto said = folder / "said";
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit seconds{kMostSeconds, kMostSeconds}, memory{kMostMemory, kMostMemory};
    ::setrlimit(RLIMIT_CPU, &seconds);
    if (!test::kSanitized) ::setrlimit(RLIMIT_AS, &memory);
    set_threads(1);
    std::string text;
    try {
      const Diagnosis diagnosis = diagnose(request, nullptr);
      const std::string fault = fault_of(s, diagnosis);
      text = fault.empty() ? "verdict " + diagnosis.report["verdict"].get<std::string>()
                           : "FAULT " + fault;
    } catch (const Error& error) {
      text = std::string(error.exit() == Exit::kFailure ? "FAULT " : "refused: ") + error.what();
    } catch (const std::exception& error) {
      text = std::string("FAULT exception: ") + error.what();
    }
    write_file(said, text);
    ::_exit(0);
  }
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  const double seconds = double(used.ru_utime.tv_sec) + double(used.ru_utime.tv_usec) * 1e-6;
  std::string text = "FAULT died of signal " + std::to_string(WTERMSIG(status));
  if (WIFEXITED(status))
    text = WEXITSTATUS(status) == 0 ? test::slurp(said) : "FAULT of a sanitizer";
  return text + " (" + std::to_string(seconds) + " s)";
}

long number_of(const char* variable, long fallback) {
  const char* text = std::getenv(variable);
  return text == nullptr ? fallback : std::atol(text);
}

TEST(AnyRecording, GivesAVerdictOrOneLine) {
  const auto first = static_cast<unsigned>(number_of("DCNN_ANY_SEED", 1));
  const auto count = static_cast<unsigned>(number_of("DCNN_ANY_CASES", test::repetitions(kCases)));
  const bool aloud = std::getenv("DCNN_ANY_CASES") != nullptr;
  int verdicts = 0, refused = 0;
  for (unsigned seed = first; seed < first + count; ++seed) {
    const std::string outcome = outcome_of(seed);
    if (aloud) std::printf("%u  %s: %s\n", seed, Situation(seed).words().c_str(), outcome.c_str());
    EXPECT_EQ(outcome.find("FAULT"), std::string::npos)
        << "DCNN_ANY_SEED=" << seed << " DCNN_ANY_CASES=1: " << Situation(seed).words() << "\n"
        << outcome;
    EXPECT_EQ(outcome.find('\n'), std::string::npos) << outcome;
    verdicts += outcome.starts_with("verdict");
    refused += outcome.starts_with("refused");
  }
  std::printf("%d verdicts, %d refusals in one line\n", verdicts, refused);
  if (count >= kCases) {
    EXPECT_GT(verdicts, 5);
  }
}

}  // namespace
}  // namespace dcnn
