// SPDX-License-Identifier: Apache-2.0
// calibration.json as dcnn-run reads it: a rotation that is none would turn every force.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/calibration/calibration.h"
#include "dcnn/core/file.h"
#include "dcnn/data/rotation.h"
#include "support/process.h"

namespace dcnn {
namespace {

Calibration written_one() {
  Calibration c;
  c.R_ES = rotation_from_euler({0.3, -0.5, 2.0});
  c.gain = 1.01;
  c.offset = {0.5, -1.5, 2.5};
  c.residual_rms = 0.25;
  c.covariance = Eigen::Vector3d(4e-6, 9e-6, 16e-6).asDiagonal();
  c.covariance(0, 1) = c.covariance(1, 0) = 1e-6;
  c.pairs = 24;
  c.notes = {"a note"};
  return c;
}

/// What reading the document says; empty where it is taken.
std::string gate(const Json& json, Calibration* read = nullptr) {
  const test::TemporaryFolder folder;
  write_file(folder / "c.json", json.dump());
  try {
    const Calibration c = read_calibration(folder / "c.json");
    if (read) *read = c;
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kData) << error.what();
    EXPECT_NE(std::string(error.what()).find("c.json"), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

bool tells(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(CalibrationFile, IsReadAsItWasWritten) {
  Calibration read;
  ASSERT_EQ(gate(to_json(written_one()), &read), "");
  EXPECT_EQ(read.R_ES, written_one().R_ES);
  EXPECT_EQ(read.offset, written_one().offset);
  EXPECT_EQ(read.gain, 1.01);
}

TEST(CalibrationFile, SaysWhatTheDocumentationSays) {
  Calibration c = written_one();
  const Json bare = to_json(c);
  EXPECT_EQ(bare["rotation_sd_rad"], (Json{2e-3, 3e-3, 4e-3}));
  EXPECT_EQ(bare["covariance_rad2"][0], (Json{4e-6, 1e-6, 0.0}));
  EXPECT_EQ(bare["rotation_es"][2][0], c.R_ES(2, 0));
  EXPECT_EQ(bare["residual_rms_n"], 0.25);
  EXPECT_EQ(bare["pairs"], 24);
  EXPECT_EQ(bare["notes"], (Json{"a note"}));
  for (const char* key : {"mass_kg", "nominal_angle_rad", "convention"}) {
    EXPECT_TRUE(bare[key].is_null()) << key;
  }
  c.mass_kg = 0.75;
  c.nominal_angle = 0.125;
  c.convention = AxisConvention{"+y -x +z", -1, 0.5};
  c.covariance(2, 2) = -1e-18;  // rounding
  const Json full = to_json(c);
  EXPECT_EQ(full["mass_kg"], 0.75);
  EXPECT_EQ(full["nominal_angle_rad"], 0.125);
  EXPECT_EQ(full["convention"]["axes"], "+y -x +z");
  EXPECT_EQ(full["convention"]["force_sign"], -1);
  EXPECT_EQ(full["convention"]["residual_rms_n"], 0.5);
  EXPECT_EQ(full["rotation_sd_rad"][2], 0.0);
}

TEST(CalibrationFile, TakesNothingButARotation) {
  const Json right = to_json(written_one());
  const auto with = [&](const Eigen::Matrix3d& M) {
    Json json = right;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) json["rotation_es"][std::size_t(i)][std::size_t(k)] = M(i, k);
    }
    return gate(json);
  };
  const Eigen::Matrix3d R = written_one().R_ES;
  EXPECT_EQ(with(R), "");
  EXPECT_EQ(with(R * (1.0 + 1e-8)), "") << "rounding in the file";
  for (const double scale : {1.0 + 1e-6, 1.0 - 1e-6, 0.0, -1.0, 2.0, 1e300}) {
    EXPECT_TRUE(tells(with(scale * R), "not a rotation")) << scale;
  }
  EXPECT_TRUE(tells(with(R * Eigen::Vector3d(1, 1, -1).asDiagonal()), "not a rotation"))
      << "a mirror";
  Eigen::Matrix3d sheared = R;
  sheared.row(1) += 1e-5 * R.row(0);
  EXPECT_TRUE(tells(with(sheared), "not a rotation"));
}

TEST(CalibrationFile, TakesNoOtherShapesAndNumbers) {
  const Json right = to_json(written_one());
  const auto with = [&](const char* key, const Json& value) {
    Json json = right;
    json[key] = value;
    return gate(json);
  };
  const Json row = {1.0, 0.0, 0.0}, longer = {1.0, 0.0, 0.0, 0.0};
  for (const Json& rows : {Json{row, row}, Json{row, row, row, row}, Json{row, row, longer},
                           Json{row, Json{1.0, 0.0}, row}, Json::array()}) {
    EXPECT_TRUE(tells(with("rotation_es", rows), "rotation_es must be 3x3")) << rows.dump();
  }
  for (const Json& offset : {Json{1.0, 2.0}, Json{1.0, 2.0, 3.0, 4.0}, Json::array()}) {
    EXPECT_TRUE(tells(with("offset_n", offset), "offset_n a list of 3")) << offset.dump();
  }
  for (const Json& value : {Json("x"), Json(true), Json::object(), Json(3.0)}) {
    EXPECT_NE(with("rotation_es", value), "") << value.dump();
    EXPECT_NE(with("offset_n", value), "") << value.dump();
  }
  for (const double gain : {0.0, -1.0, 1e-300, 1e300}) {
    EXPECT_TRUE(tells(with("gain", gain), "gain must be between 1e-06 and 1e+06")) << gain;
  }
  for (const double gain : {1.0 / 1e6, 1e6}) EXPECT_EQ(with("gain", gain), "") << gain;
  for (const double most : {1e9, -1e9}) {
    EXPECT_EQ(with("offset_n", {0.0, most, 0.0}), "");
    EXPECT_TRUE(tells(with("offset_n", {0.0, 1.0001 * most, 0.0}), "offset_n"));
  }
  Json missing = right;
  missing.erase("rotation_es");
  EXPECT_NE(gate(missing), "");
  Json optional = right;
  optional.erase("gain");
  optional.erase("offset_n");
  Calibration read;
  EXPECT_EQ(gate(optional, &read), "");
  EXPECT_EQ(read.gain, 1.0);
  EXPECT_EQ(read.offset, Eigen::Vector3d::Zero().eval());
}

}  // namespace
}  // namespace dcnn
