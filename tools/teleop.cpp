// SPDX-License-Identifier: Apache-2.0
#include "dcnn/teleop/teleop.h"

#include <iostream>
#include <set>

#include "dcnn/calibration/calibration.h"
#include "dcnn/experiment/teleop_report.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-teleop --out teleop                              # tool known, no feedback, raw "
    "force\n"
    "  dcnn-train --online --train train.csv --out m.dcnn\n"
    "  dcnn-teleop --model m.dcnn --out teleop               # the model in the loop\n"
    "  dcnn-teleop --corrected report/model.json --calibration c.json --out teleop\n"
    "\n"
    "A hand moves a master, a delayed slave follows and touches a wall; the force that its sensor\n"
    "reads, less what the tool itself does, returns to the hand. Models must be trained with\n"
    "--online at 500 Hz. configs/teleop.json holds every number, among them delay, jitter, loss,\n"
    "dead zone and link.passivity.";

std::string unique_name(std::string name, std::set<std::string>& taken) {
  const std::string stem = name;
  for (int k = 2; !taken.insert(name).second; ++k) name = stem + "-" + std::to_string(k);
  return name;
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-teleop", "Bilateral teleoperation with the tool's force compensated (Fig. 6).",
            kExamples);
  std::filesystem::path config_path, corrected, calibration, out;
  std::vector<std::filesystem::path> models;
  tool.option("--config", config_path, "configuration (default: that of configs/teleop.json)")
      .holds({FileKind::kTeleop});
  tool.option("--model", models, "trained models (.dcnn)").holds({FileKind::kModel});
  tool.option("--corrected", corrected, "simulator that compensates (model.json of dcnn-diagnose)")
      .holds({FileKind::kSimulator});
  tool.option("--calibration", calibration, "sensor frame to robot frame (dcnn-calibrate)")
      .holds({FileKind::kCalibration});
  tool.output("--out", out, "folder for report.html, teleop.json, SVG and CSV",
              {"report.html", "teleop.json", "*.svg", "*.csv"})
      .required();
  const SeedFlag seed_flag(tool);

  return tool.run(argc, argv, [&] {
    const TeleopConfig config =
        parse_teleop(config_path.empty() ? Json::object() : read_json(config_path, Exit::kUsage),
                     config_path.string());
    const Eigen::Matrix3d R_ES =
        calibration.empty() ? config.tool.model.R_ES() : read_calibration(calibration).R_ES;
    const std::uint64_t seed = seed_flag.value();

    std::vector<Variant> variants;
    variants.push_back({"ideal", Variant::Kind::kIdeal, nullptr});
    variants.push_back({"none", Variant::Kind::kNone, nullptr});
    variants.push_back({"ns", Variant::Kind::kMeasured, nullptr});
    std::set<std::string> taken{"ideal", "none", "ns"};
    std::vector<Identifier> identifiers;
    identifiers.reserve(models.size());
    for (const auto& path : models) {
      identifiers.push_back(read_identifier(path));
      variants.push_back({unique_name(identifiers.back().name, taken), Variant::Kind::kMeasured,
                          compensate_with(identifiers.back(), path.string())});
    }
    if (!corrected.empty()) {
      variants.push_back({unique_name("corrected", taken), Variant::Kind::kMeasured,
                          compensate_with(read_simulator(corrected), corrected.string())});
    }

    Progress progress(tool.common().quiet);
    std::vector<TeleopResult> results;
    for (Variant& variant : variants) {
      progress.update(static_cast<double>(results.size()) / static_cast<double>(variants.size()),
                      name_of_variant(variant.name));
      TeleopTrace trace = run_teleop(config, variant, R_ES, seed);
      Json row = summarise(trace, config, variant.name);
      if (!row["stable"].get<bool>()) {
        tool.note(name_of_variant(variant.name) +
                  ": the contact is not stable (the slave leaves the wall " +
                  row["bounces"].dump() + " times); set link.passivity, or less feedback.scale");
      }
      results.push_back({variant.name, std::move(trace), std::move(row)});
    }
    progress.clear();
    write_teleop(out, config, results, seed);
    Json rows = Json::array();
    for (const auto& result : results) rows.push_back(result.row);
    if (tool.common().json) {
      Tool::print({{"variants", rows}});
    } else {
      for (const auto& row : rows) {
        std::cout << teleop_line(row) << "\n";
      }
      std::cout << (out / "report.html").string() << "\n";
    }
    return Exit::kDone;
  });
}
