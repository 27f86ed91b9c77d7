// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "dcnn/conceal/arm.h"
#include "dcnn/conceal/axis.h"
#include "dcnn/conceal/challenge.h"
#include "dcnn/conceal/faulty.h"
#include "dcnn/conceal/inject.h"
#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/experiment/challenge_report.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-conceal --scenarios 30 --seed 1 --out set --seal set.sealed.json\n"
    "  dcnn-conceal --scenario single:0.5/coulomb_friction/7 --seed 1 --out set --seal one.json\n"
    "  dcnn-diagnose --sim set/s0001/sim.json --fit set/s0001/fit_*.csv \\\n"
    "    --holdout set/s0001/holdout_*.csv --out set/reports/s0001\n"
    "  dcnn-conceal --inject coulomb_friction@tool_z --amplitude 0.5 --motion log.csv \\\n"
    "    --sim sim.json --out hidden --seal hidden.sealed.json       # in your own recording\n"
    "  dcnn-conceal --scenario poor:0.5/gain/1 --on motion.csv --out again --seal again.json  # "
    "the same\n"
    "                                       # scenario, with one more recording, on that motion\n"
    "  dcnn-conceal --score --out set --seal set.sealed.json    # set/scores.json, "
    "set/report.html\n";

constexpr int kMostScenarios = 9999;  // their folders are s0001 to s9999

Exit print(const Tool& tool, std::size_t scenarios, std::uint64_t seed, const std::string& digest,
           const std::filesystem::path& seal) {
  if (tool.common().json) {
    Tool::print({{"scenarios", scenarios}, {"seed", seed}, {"sha256", digest}});
  } else {
    std::cout << digest << "  " << seal.string() << "\n";
  }
  return Exit::kDone;
}

/// OUT/log.csv and OUT/sim.json or OUT/system.json with one fault, its name in the seal.
std::string write_faulty(const std::string& kind, const std::filesystem::path& motion,
                         std::uint64_t seed, const std::filesystem::path& out,
                         const std::filesystem::path& seal) {
  conceal::FaultyLog log;
  if (motion.empty()) {
    log = conceal::make_faulty(kind, seed);
  } else {
    log.table = conceal::with_fault(kind, read_csv(motion), seed);
  }
  FileSet files(out);
  for (const char* earlier : {"sim.json", "system.json"}) files.replaces(earlier);
  write_csv(out / "log.csv", log.table);
  if (!log.simulator.is_null()) write_file(out / "sim.json", log.simulator.dump(2) + "\n");
  if (!log.system.is_null()) write_file(out / "system.json", log.system.dump(2) + "\n");
  const std::string digest =
      conceal::write_seal({{"kind", kind}, {"fault", log.fault}, {"seed", seed}}, out, seal);
  files.commit();
  return digest;
}

/// A family of machines: what begins its ids, its plan, and what writes it.
struct Machines {
  const char* prefix;
  std::vector<std::string> (*plan)(int, std::uint64_t);
  std::string (*conceal)(const std::vector<std::string>&, std::uint64_t,
                         const std::filesystem::path&, const std::filesystem::path&,
                         const std::function<void(int, int)>&);
};
constexpr Machines kArms{"arm+", conceal::arm_plan, conceal::conceal_arms};
constexpr Machines kAxes{"axis+", conceal::axis_plan, conceal::conceal_axes};

/// So many of a family, or those of `ids` (with its prefix before them).
Exit print_machines(const Tool& tool, const Machines& family, int count,
                    std::vector<std::string> ids, std::uint64_t seed,
                    const std::filesystem::path& out, const std::filesystem::path& seal) {
  if (ids.empty()) ids = family.plan(count, seed);
  const std::string prefix = family.prefix;
  for (std::string& id : ids) {
    if (id.starts_with(prefix)) id = id.substr(prefix.size());
  }
  Progress bar(tool.common().quiet);
  const std::string digest = family.conceal(ids, seed, out, seal, [&](int done, int total) {
    bar.update(static_cast<double>(done) / total, std::to_string(done) + " machines");
  });
  bar.clear();
  return print(tool, ids.size(), seed, digest, seal);
}

/// Opens the seal: OUT/scores.json and OUT/report.html.
Exit judge(const Tool& tool, const std::filesystem::path& out, const std::filesystem::path& seal) {
  const Json scores = conceal::score_challenge(out, seal);
  write_challenge(out, scores);
  if (tool.common().json) {
    Tool::print(scores);
  } else {
    std::cout << challenge_text(scores);
  }
  return Exit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-conceal",
            "Makes recordings in which effects are concealed, with the simulator that knows "
            "nothing of them, and seals the answers: their SHA-256 is printed and stored before "
            "anybody looks. --score opens the seal.",
            kExamples);
  int scenarios = 0, rounds = 0, laws = 0, arms = 0, axes = 0;
  bool score = false, list = false;
  std::vector<std::string> ids;
  std::string family = "plain";
  std::filesystem::path out, seal;
  std::string fault;
  std::vector<std::filesystem::path> on;
  conceal::Injection injection;
  auto many = tool.option("--scenarios", scenarios, "how many, of every group its share")
                  .between(1, kMostScenarios);
  tool.option("--scenario", ids, "these, as a sealed file names them under `drawn`").excludes(many);
  tool.option(
          "--rates", rounds,
          "rounds of a table of rates: of each 75 nulls, every effect alone at 1, 0.3 and 0.1 or "
          "0.05 of the noise, and some of every other group (8: 1,600 scenarios)")
      .between(1, kMostScenarios)
      .excludes(many);
  const Option whole_arms =
      tool.option("--arms", arms,
                  "so many arms of 6 or 7 joints: payloads, effects in their joints")
          .between(1, kMostScenarios)
          .excludes(many);
  const Option single_axes =
      tool.option("--axes", axes,
                  "so many single axes (joints, motors, slides, oscillators) with the logs of "
                  "their drives: effects of an axis, alone and together, and laws that no "
                  "catalogue has")
          .between(1, kMostScenarios)
          .excludes(many)
          .excludes(whole_arms);
  tool.option("--laws", laws,
              "so many laws that no catalogue has, in turn, at 1, 3 and 10 times the noise")
      .between(1, kMostScenarios)
      .excludes(many);
  tool.option(
          "--family", family,
          "conditions of the recordings: plain, tremor (of a hand), load (noise that grows with "
          "the force), clock (200 to 2000 Hz, rows lost), field (some of each), hardware (plain, "
          "with laws that hardware has: load friction, creep), wrench (force and torque), all (in "
          "turn)")
      .with_default();
  tool.option("--on", on,
              "motions (t, x,y,z, alpha,beta,gamma) on which every scenario is recorded once more, "
              "after its own "
              "recordings: same tool, effects and sensor")
      .holds({FileKind::kRecording});
  const Option opening =
      tool.flag("--score", score, "score OUT/reports/*/report.json against the seal")
          .excludes(many);
  tool.flag("--list-faults", list, "prints the names for --fault");
  tool.output("--out", out, "folder of the scenarios",
              {"s[0-9][0-9][0-9][0-9]", "seal.sha256", "sim.json", "system.json", "*.csv"})
      .unless(opening);
  tool.output("--seal", seal, "file of the answers, outside that folder").unless(opening).held();

  auto what = tool.option("--inject", injection.what,
                          "effect, effect@axis or a JSON file of effects to hide in --motion");
  const Option motion = tool.option("--motion", injection.motion, "recordings of a tool")
                            .holds({FileKind::kRecording});
  what.excludes(many).needs(motion);
  tool.option("--fault", fault,
              "a log with this fault (for dcnn-check), in --motion or in one of its own")
      .one_of(conceal::faulty_kinds())
      .excludes(many)
      .excludes(what);
  const auto sim = tool.option("--sim", injection.simulator, "their simulator (sim.json)")
                       .needs(what)
                       .holds({FileKind::kSimulator});
  tool.option("--system", injection.system, "of a machine of one axis, instead of --sim")
      .needs(what)
      .excludes(sim)
      .holds({FileKind::kSystem});
  tool.option("--amplitude", injection.amplitude, "of --inject, in units of --noise")
      .with_default()
      .positive()
      .needs(what);
  tool.option("--noise", injection.noise, "N (default: the log's, from its second differences)")
      .positive()
      .needs(what);
  const ReadFlags read(tool);

  tool.check([&] {
    if (!score || out.empty() || seal.empty()) return;
    require(std::filesystem::exists(out / "seal.sha256"), Exit::kData, out.string(),
            ": holds no seal.sha256; --score takes the folder that dcnn-conceal --out wrote");
    require(std::filesystem::exists(seal), Exit::kData, seal.string(),
            ": does not exist; --seal names the file of answers that dcnn-conceal --seal wrote");
  });
  const SeedFlag seed_flag(tool);

  return tool.run(argc, argv, [&] {
    if (list && tool.common().json) {
      Tool::print({{"faults", conceal::faulty_kinds()}});
      return Exit::kDone;
    }
    if (list) {
      for (const std::string& kind : conceal::faulty_kinds()) std::cout << kind << "\n";
      return Exit::kDone;
    }
    require(!out.empty() && !seal.empty(), Exit::kUsage, "--out and --seal are required");
    if (score) return judge(tool, out, seal);
    const std::uint64_t seed = seed_flag.value();
    if (!fault.empty()) {
      const auto log = injection.motion.empty() ? std::filesystem::path() : injection.motion[0];
      return print(tool, 1, seed, write_faulty(fault, log, seed, out, seal), seal);
    }
    if (what.given()) {
      require(injection.simulator.empty() != injection.system.empty(), Exit::kUsage,
              "--inject needs --sim, or --system of another machine");
      injection.read = read.options();
      return print(tool, 1, seed, conceal::inject(injection, seed, out, seal), seal);
    }
    const std::string first = ids.empty() ? "" : ids.front();
    if (whole_arms.given() || first.starts_with(kArms.prefix)) {
      return print_machines(tool, kArms, arms, ids, seed, out, seal);
    }
    if (single_axes.given() || first.starts_with(kAxes.prefix)) {
      return print_machines(tool, kAxes, axes, ids, seed, out, seal);
    }
    require(scenarios > 0 || rounds > 0 || laws > 0 || !ids.empty(), Exit::kUsage,
            "give --scenarios, --rates, --laws, --arms, --axes, --scenario, --inject or --score");
    if (laws > 0) ids = conceal::laws_plan(laws);
    if (rounds > 0) ids = conceal::rates_plan(rounds, seed);
    if (ids.empty()) ids = conceal::plan(scenarios, seed);
    ids = conceal::in_family(std::move(ids), family);
    std::vector<Recording> motions;
    ReadOptions pose_alone = read.options();
    pose_alone.motion_only = true;
    for (const auto& file : on) motions.push_back(read_recording(file, pose_alone, System()));
    Progress bar(tool.common().quiet);
    const std::string digest = conceal::conceal_challenge(
        ids, seed, out, seal,
        [&](int done, int total) {
          bar.update(static_cast<double>(done) / total, std::to_string(done) + " scenarios");
        },
        motions);
    bar.clear();
    return print(tool, ids.size(), seed, digest, seal);
  });
}
