// SPDX-License-Identifier: Apache-2.0
// Recordings of real machines, where they are beside the checkout.
#include <gtest/gtest.h>

#include "data/testing.h"
#include "dcnn/data/features.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

System one_axis(const std::string& measured, const std::string& position) {
  return parse_system({{"kind", "axes"},
                       {"axes", {{{"name", "a"}, {"measured", measured}, {"position", position}}}}},
                      "s");
}

System system_of(const std::string& folder) {
  if (folder == "ntnu_wrist") return {};
  if (folder == "davinci_tool") return one_axis("spindle_torque_Nm", "spindle_rad");
  if (folder == "emps") return one_axis("force_N", "q_m");
  if (folder == "silverbox") return one_axis("y_V", "u_V");
  if (folder == "ur10e") return one_axis("i_A_1", "q_1");
  return one_axis("tau_1", folder == "kuka_kr300" ? "qmot_1" : "q_1");
}

TEST(RealLogs, AreReadWithFiniteFeatures) {
  const fs::path folder = testing::shared("data");
  if (folder.empty()) GTEST_SKIP() << "../shared/data is absent";
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    const std::string rig = entry.path().parent_path().filename().string();
    const System system = system_of(rig);
    ReadOptions options;
    options.static_list = entry.path().filename() == "static_24_poses.csv";
    options.resample = rig == "panda" || rig == "ur10e";
    const Recording recording = read_recording(entry.path(), options, system);
    FeatureSpec spec;
    spec.set = FeatureSpec::Set::kBody;
    const auto x = make_features(recording, make_layout({recording}, spec, system)).x;
    EXPECT_TRUE(x.allFinite()) << entry.path();
    EXPECT_EQ(x.rows(), recording.samples());
    ++files;
  }
  EXPECT_GT(files, 40);
}

TEST(RealLogs, AnIrregularClockNeedsResampling) {
  const fs::path path = testing::shared("data/panda/panda_exciting_1.csv");
  if (path.empty()) GTEST_SKIP() << "../shared/data is absent";
  const System system = system_of("panda");
  const auto message = testing::error_of([&] { read_recording(path, {}, system); }, Exit::kData);
  EXPECT_TRUE(testing::contains(message, "--resample")) << message;
  ReadOptions options;
  options.resample = true;
  options.resample_hz = 1000.0;
  EXPECT_EQ(read_recording(path, options, system).dt, 0.001);
}

}  // namespace
}  // namespace dcnn
