// SPDX-License-Identifier: Apache-2.0
#include <iomanip>
#include <iostream>
#include <numbers>

#include "dcnn/calibration/calibration.h"
#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/core/number.h"
#include "dcnn/data/rotation.h"
#include "dcnn/experiment/calibration_report.h"
#include "dcnn/physics/motion.h"
#include "support/doctor.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-calibrate --pairs pairs.csv --out calibration.json     # columns sx,sy,sz,rx,ry,rz\n"
    "  dcnn-calibrate --loaded with.csv --unloaded without.csv --mass-kg 0.5 --out c.json\n"
    "  dcnn-calibrate --static poses.csv --with-bias --out c.json  # the tool is the weight\n"
    "  dcnn-calibrate --static poses.csv --with-bias --nominal 0 0 -0.52 --out c.json\n"
    "\n"
    "A pair is one force as the sensor reads it (s, in S) and as it is in the pose frame (r, in "
    "E);\n"
    "the answer is r = R_ES*s + offset. Six or more orientations that load all three axes are\n"
    "enough. With --nominal (rx ry rz, the mounting as designed) it says which reading of the\n"
    "sensor's axes and sign fits when the data contradict it.";

struct Input {
  std::filesystem::path pairs, loaded, unloaded, poses;
  std::optional<double> mass_kg;
};

/// Acceleration of the tool as a share of gravity, root mean square; 0 for poses at rest. Of a pose
/// without a position that of a point kLever from the axis it turns about.
double acceleration_of(const Recording& recording) {
  constexpr double kLever = 0.1;  // m, a tool's centre of mass from its wrist
  const Motion motion = motion_of(recording, ToolModel(), DerivativeSpec());
  if (motion.is_static() || motion.samples() == 0) return 0.0;
  const bool placed = motion.a_B.rows() == motion.samples();
  const double square =
      placed ? motion.a_B.squaredNorm() : kLever * kLever * motion.dw_S.squaredNorm();
  return std::sqrt(square / static_cast<double>(motion.samples())) / 9.81;
}

/// Poses at rest: logged with a clock, a tool that hardly accelerates.
Recording read_poses(const std::filesystem::path& path, ReadOptions read) {
  constexpr double kMost = 0.03;  // of the weight, as inertial force: 2 degrees of its direction
  read.static_list = true;
  Recording recording = read_recording(path, read, System());
  const double share = acceleration_of(recording);
  require(share < kMost, Exit::kData, path.string(), ": the tool accelerates by ",
          brief(9.81 * share),
          " m/s^2 (rms) in these rows, which are no poses at rest; keep the "
          "rows at rest, or identify tool and mounting from the motion: dcnn-identify");
  return recording;
}

ForcePairs load(const Input& input, const ReadOptions& read, bool with_bias) {
  const int given = !input.pairs.empty() + !input.loaded.empty() + !input.poses.empty();
  require(given == 1, Exit::kUsage,
          "give one of --pairs, --loaded with --unloaded, and --static; see dcnn-calibrate --help");
  require(input.loaded.empty() == input.unloaded.empty(), Exit::kUsage,
          "--loaded and --unloaded belong together");
  if (!input.pairs.empty()) {
    require(!input.mass_kg, Exit::kUsage, "--mass-kg has no meaning with --pairs");
    ForcePairs pairs = read_pairs(input.pairs);
    pairs.sensor *= read.force_sign;
    return pairs;
  }
  if (!input.poses.empty()) {
    return static_pairs(read_poses(input.poses, read), input.mass_kg, with_bias);
  }
  require(input.mass_kg.has_value(), Exit::kUsage, "--loaded needs the hung mass: --mass-kg M");
  return weight_pairs(read_poses(input.loaded, read), read_poses(input.unloaded, read),
                      *input.mass_kg);
}

/// Signs, axes and the mounting are what a calibration finds itself; not a force that is in another
/// frame than the sensor's in every pose, or without the weight. What is likely, a line each.
std::vector<std::string> check_recordings(const Tool& tool, const Doctor& doctor,
                                          const Input& input, const ReadOptions& read) {
  CheckRequest logs{{}, read, "", ""};
  for (const auto& path : {input.loaded, input.unloaded, input.poses}) {
    if (!path.empty()) logs.logs.push_back(path);
  }
  const std::vector<std::string> own{"reaction",     "force_sign", "force_axes",  "mounting",
                                     "inverse_pose", "angle_sign", "euler_order", "force_unit"};
  std::vector<std::string> lines;
  for (const Suspicion& one : doctor.examine(tool, logs, own).likely) lines.push_back(one.line);
  return lines;
}

void print(const Calibration& c, const std::filesystem::path& out) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const Eigen::Vector3d rpy = kDegrees * euler_from_rotation(c.R_ES).reverse();
  const Eigen::Vector3d sd = kDegrees * c.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  std::cout << headline(c) << std::fixed << std::setprecision(2) << "\n\nturn        " << rpy.x()
            << ", " << rpy.y() << ", " << rpy.z() << " deg about x, y, z (Rz*Ry*Rx), sd " << sd.x()
            << ", " << sd.y() << ", " << sd.z() << " deg\n"
            << std::setprecision(3) << "offset      " << c.offset.x() << ", " << c.offset.y()
            << ", " << c.offset.z() << " N\ngain        " << c.gain << " (reported, not applied)\n";
  if (c.mass_kg) std::cout << "mass        " << *c.mass_kg << " kg\n";
  if (c.nominal_angle) {
    std::cout << "nominal     " << kDegrees * *c.nominal_angle << " deg away\n";
  }
  std::cout << "file        " << out.string() << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-calibrate", "Aligns the sensor's frame with the robot's from known forces.",
            kExamples);
  Input input;
  std::filesystem::path out, page;
  CalibrationOptions options;
  std::vector<double> nominal;
  tool.option("--pairs", input.pairs, "CSV of pairs: sx,sy,sz,rx,ry,rz [N], optionally w")
      .holds({FileKind::kRecording});
  tool.option("--loaded", input.loaded, "static poses with a mass hung at the tip")
      .holds({FileKind::kRecording});
  tool.option("--unloaded", input.unloaded, "the same poses without it")
      .holds({FileKind::kRecording});
  tool.option("--static", input.poses, "static poses; gravity on the tool is the reference")
      .holds({FileKind::kRecording});
  tool.option("--mass-kg", input.mass_kg, "hung mass, or the tool's (else it is estimated)");
  tool.flag("--with-bias", options.with_bias, "the sensor has a constant offset: find it");
  tool.option("--nominal", nominal, "mounting as designed: rx ry rz [rad]")
      .values(3, "numbers rx ry rz [rad]");
  tool.output("--out", out, "calibration.json to write").required();
  tool.output("--report", page, "page to write (HTML): what each pair leaves");
  const ReadFlags read(tool);
  const Doctor doctor(tool);

  return tool.run(argc, argv, [&] {
    if (!nominal.empty()) {
      options.nominal = rotation_from_euler({nominal[2], nominal[1], nominal[0]});
    }
    const auto warnings = check_recordings(tool, doctor, input, read.options());
    const ForcePairs pairs = load(input, read.options(), options.with_bias);
    const Calibration result = calibrate(pairs, options);
    const Json json = to_json(result);
    FileSet files(out.parent_path());
    write_file(out, json.dump(2) + "\n");
    if (!page.empty()) write_file(page, to_html(result, pairs, warnings));
    files.commit();
    for (const auto& note : result.notes) tool.note(note);
    if (tool.common().json) {
      Tool::print(json);
    } else {
      print(result, out);
    }
    return Exit::kDone;
  });
}
