// SPDX-License-Identifier: Apache-2.0
// Joints of which the held-out block shows nothing, for they stand still in it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/experiment/diagnosis_report.h"
#include "support/process.h"

namespace dcnn {
namespace {

/// 15 s at 125 Hz of two joints with their simulated torques: one moves all the time, the other not
/// about 2.5, 7.5 and 12.5 s, where the pieces are that a recording so short holds out.
void write_joints(const std::filesystem::path& path) {
  Rng rng({5});
  Table table;
  table.columns = {"t", "qa", "qb", "ta", "tb", "sa", "sb"};
  table.values.resize(1875, 7);
  for (Index k = 0; k < table.values.rows(); ++k) {
    const double t = 0.008 * static_cast<double>(k), turn = 2.0 * std::numbers::pi * t;
    const double moving = std::clamp(t - 3.5, 0.0, 3.0) + std::clamp(t - 8.5, 0.0, 3.0);
    const double qa = std::sin(0.7 * turn), qb = std::sin(0.5 * 2.0 * std::numbers::pi * moving);
    const double sa = std::cos(qa), sb = 0.5 * std::cos(qb);
    table.values.row(k) << t, qa, qb, sa + 0.02 * rng.normal(), sb + 0.02 * rng.normal(), sa, sb;
  }
  write_csv(path, table);
}

TEST(HeldOutJoints, OneOfWhichNothingIsHeldOutHasNoErrorThere) {
  test::TemporaryFolder folder;
  write_joints(folder / "log.csv");
  Json axes = Json::array();
  for (const std::string name : {"a", "b"}) {
    axes.push_back({{"name", name},
                    {"measured", "t" + name},
                    {"simulated", "s" + name},
                    {"position", "q" + name},
                    {"unit", "N*m"}});
  }
  write_file(folder / "system.json", Json{{"kind", "axes"}, {"axes", axes}}.dump());
  DiagnosisRequest request;
  request.system = folder / "system.json";
  request.fit = {folder / "log.csv"};
  const Diagnosis diagnosis = diagnose(request, nullptr);
  const Json& fit = diagnosis.report["fit"];
  for (const char* key : {"holdout_rmse_before", "holdout_rmse_after", "holdout_noise_floor"}) {
    ASSERT_EQ(fit[key].size(), 2U) << key;
    EXPECT_NEAR(fit[key][0].get<double>(), 0.02, 0.003) << key;
    EXPECT_TRUE(fit[key][1].is_null()) << key;
  }
  EXPECT_EQ(diagnosis.report["verdict"], "consistent");
  EXPECT_NE(headline(diagnosis.report).find("held-out ta"), std::string::npos)
      << headline(diagnosis.report);
  EXPECT_NO_THROW(write_diagnosis(folder / "report", diagnosis));
}

}  // namespace
}  // namespace dcnn
