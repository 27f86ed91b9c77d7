// SPDX-License-Identifier: Apache-2.0
// Payloads for others, read back: by urdfdom, libsdformat and PyYAML where they are installed.
#include "dcnn/identification/payload.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "data/testing.h"
#include "dcnn/core/json.h"
#include "dcnn/data/rotation.h"
#include "support/process.h"

#ifdef DCNN_WITH_URDFDOM
#include <urdf_parser/urdf_parser.h>
#endif
#ifdef DCNN_WITH_SDFORMAT
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/Root.hh>
#endif

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::contains;

constexpr double kSame = 1e-9;  // of what is exported

PayloadBody some_payload() {
  PayloadBody p;
  p.mass = 0.7543210987654321;
  p.com = {0.0123456789, -0.023456789, 0.161803398875};
  Matrix3d R = rotation_from_euler({0.3, -0.2, 0.1});
  p.inertia_com = R * Vector3d(0.0031, 0.0042, 0.0011).asDiagonal() * R.transpose();
  return p;
}

/// Every number behind `from`, comments left out.
std::vector<double> numbers(const std::string& text, const std::string& from) {
  static const std::regex number(R"([-+]?\d+\.?\d*(?:[eE][-+]?\d+)?)");
  const std::string rest = text.substr(text.find(from) + from.size());
  std::vector<double> all;
  for (std::sregex_iterator it(rest.begin(), rest.end(), number), end; it != end; ++it) {
    all.push_back(std::stod(it->str()));
  }
  return all;
}

Matrix3d symmetric(const std::vector<double>& v, std::size_t k) {  // xx yy zz xy xz yz
  Matrix3d I;
  I << v[k], v[k + 3], v[k + 4], v[k + 3], v[k + 1], v[k + 5], v[k + 4], v[k + 5], v[k + 2];
  return I;
}

TEST(Payload, OfAToolIsItsBodyInTheFlange) {
  ToolModel model;
  model.mass = 2.0;
  model.com = {0.1, 0.0, 0.0};
  model.sensor_rotation_rpy = {0.0, 0.0, M_PI / 2};  // the sensor's x is the flange's y
  model.inertia = Matrix3d(Vector3d(0.01, 0.04, 0.05).asDiagonal());
  const PayloadBody p = payload_of(model);
  EXPECT_LT((p.com - Vector3d(0.0, 0.1, 0.0)).norm(), 1e-15);
  const Matrix3d expected = Vector3d(0.04 - 0.02, 0.01, 0.05 - 0.02).asDiagonal();
  EXPECT_LT((*p.inertia_com - expected).norm(), 1e-15);
  EXPECT_NEAR(p.moments()[0], 0.01, 1e-15);
  EXPECT_NEAR(p.axes().determinant(), 1.0, 1e-12);
}

TEST(Payload, UrScriptTakesThemInItsOrder) {
  const PayloadBody p = some_payload();
  const auto v = numbers(payload_text("ur", p), "\nset_target_payload");
  ASSERT_EQ(v.size(), 10U);
  EXPECT_NEAR(v[0], p.mass, kSame);
  EXPECT_LT((Vector3d(v[1], v[2], v[3]) - p.com).norm(), kSame);
  EXPECT_LT((symmetric(v, 4) - *p.inertia_com).norm(), kSame);
}

TEST(Payload, FrankaTakesAColumnMajorMatrix) {
  const PayloadBody p = some_payload();
  const Json json = parse_json(payload_text("franka", p), "franka", Exit::kData);
  EXPECT_EQ(json["mass"].get<double>(), p.mass);
  const auto I = json["inertia"].get<std::vector<double>>();
  ASSERT_EQ(I.size(), 9U);
  EXPECT_LT((Matrix3d(Eigen::Map<const Matrix3d>(I.data())) - *p.inertia_com).norm(), kSame);
  EXPECT_EQ(json["centerOfMass"].get<std::vector<double>>()[2], p.com[2]);
  EXPECT_EQ(json["transformation"].size(), 16U);
}

TEST(Payload, KukaTakesMillimetresDegreesAndPrincipalMoments) {
  const PayloadBody p = some_payload();
  const auto v = numbers(payload_text("kuka", p), "PAYLOAD=");
  ASSERT_EQ(v.size(), 10U);
  EXPECT_NEAR(v[0], p.mass, kSame);
  EXPECT_LT((Vector3d(v[1], v[2], v[3]) / 1e3 - p.com).norm(), kSame);
  const Matrix3d R = rotation_from_euler(Vector3d(v[4], v[5], v[6]) * M_PI / 180.0);
  const Matrix3d I = R * Vector3d(v[7], v[8], v[9]).asDiagonal() * R.transpose();
  EXPECT_LT((I - *p.inertia_com).norm(), kSame);
  EXPECT_LT(Vector3d(v[4], v[5], v[6]).norm(), 30.0);  // the least turn
}

TEST(Payload, AbbTakesMillimetresAndAQuaternion) {
  const PayloadBody p = some_payload();
  const auto v = numbers(payload_text("abb", p), "payload :=");
  ASSERT_EQ(v.size(), 11U);
  EXPECT_LT((Vector3d(v[1], v[2], v[3]) / 1e3 - p.com).norm(), kSame);
  const Matrix3d R = rotation_from_quaternion({v[4], v[5], v[6], v[7]});
  const Matrix3d I = R * Vector3d(v[8], v[9], v[10]).asDiagonal() * R.transpose();
  EXPECT_LT((I - *p.inertia_com).norm(), kSame);
}

TEST(Payload, MujocoTakesAFullInertia) {
  const PayloadBody p = some_payload();
  const std::string text = payload_text("mujoco", p);
  const auto v = numbers(text, "<inertial");
  ASSERT_EQ(v.size(), 10U);
  EXPECT_LT((Vector3d(v[0], v[1], v[2]) - p.com).norm(), kSame);
  EXPECT_NEAR(v[3], p.mass, kSame);
  EXPECT_LT((symmetric(v, 4) - *p.inertia_com).norm(), kSame);
}

TEST(Payload, WithoutAnInertiaEveryFormatSaysSo) {
  PayloadBody p = some_payload();
  p.inertia_com.reset();
  for (const std::string& format : payload_formats()) {
    EXPECT_TRUE(contains(payload_text(format, p), "inertia is unknown")) << format;
    EXPECT_TRUE(contains(payload_text(format, p), "flange")) << format;
  }
}

TEST(Payload, WhatNoMotionShowedIsMarkedInEveryFormat) {
  PayloadBody p = some_payload();
  EXPECT_EQ(not_identified(p), "");
  p.assumed = {"inertia_kgm2"};
  const std::string words = not_identified(p);
  EXPECT_TRUE(words.starts_with("NOT IDENTIFIED: the recordings do not show the inertia;"))
      << words;
  for (const std::string& format : payload_formats()) {
    EXPECT_TRUE(contains(payload_text(format, p), words)) << format;
  }
}

TEST(Payload, UrdfdomReadsTheUrdf) {
#ifdef DCNN_WITH_URDFDOM
  const PayloadBody p = some_payload();
  const auto robot = urdf::parseURDF(payload_text("urdf", p));
  ASSERT_TRUE(robot);
  const auto inertial = robot->getLink("payload")->inertial;
  ASSERT_TRUE(inertial);
  EXPECT_NEAR(inertial->mass, p.mass, kSame);
  const auto& at = inertial->origin.position;
  EXPECT_LT((Vector3d(at.x, at.y, at.z) - p.com).norm(), kSame);
  Matrix3d I;
  I << inertial->ixx, inertial->ixy, inertial->ixz, inertial->ixy, inertial->iyy, inertial->iyz,
      inertial->ixz, inertial->iyz, inertial->izz;
  EXPECT_LT((I - *p.inertia_com).norm(), kSame);
#else
  GTEST_SKIP() << "without liburdfdom-dev";
#endif
}

TEST(Payload, SdformatReadsTheSdf) {
#ifdef DCNN_WITH_SDFORMAT
  const PayloadBody p = some_payload();
  sdf::Root root;
  const auto errors = root.LoadSdfString(payload_text("sdf", p));
  for (const auto& error : errors) ADD_FAILURE() << error.Message();
  ASSERT_NE(root.Model(), nullptr);
  const auto inertial = root.Model()->LinkByName("payload")->Inertial();
  EXPECT_NEAR(inertial.MassMatrix().Mass(), p.mass, kSame);
  const auto at = inertial.Pose().Pos();
  EXPECT_LT((Vector3d(at.X(), at.Y(), at.Z()) - p.com).norm(), kSame);
  const auto moi = inertial.MassMatrix().Moi();
  for (unsigned i = 0; i < 3; ++i) {
    for (unsigned k = 0; k < 3; ++k) {
      EXPECT_NEAR(moi(i, k), (*p.inertia_com)(i, k), kSame);
    }
  }
#else
  GTEST_SKIP() << "without libsdformat-dev";
#endif
}

TEST(Payload, PyYamlReadsTheParameters) {
  if (std::system("/usr/bin/python3 -c 'import yaml' 2>/dev/null") != 0) {
    GTEST_SKIP() << "without python3-yaml";
  }
  const PayloadBody p = some_payload();
  const test::TemporaryFolder folder;
  const auto in = folder / "payload.yaml", out = folder / "payload.json";
  std::ofstream(in) << payload_text("ros2-yaml", p);
  const std::string command =
      "/usr/bin/python3 -c 'import json,sys,yaml; json.dump(yaml.safe_load(open(sys.argv[1])), "
      "open(sys.argv[2], \"w\"))' " +
      in.string() + " " + out.string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  const Json json = read_json(out, Exit::kData);
  const Json cog = json["admittance_controller"]["ros__parameters"]["gravity_compensation"]["CoG"];
  EXPECT_NEAR(cog["force"].get<double>(), 9.81 * p.mass, kSame);
  EXPECT_EQ(cog["pos"].get<std::vector<double>>()[1], p.com[1]);
  EXPECT_EQ(json["payload"]["ros__parameters"]["mass"].get<double>(), p.mass);
}

}  // namespace
}  // namespace dcnn
