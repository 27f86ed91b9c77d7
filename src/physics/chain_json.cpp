// SPDX-License-Identifier: Apache-2.0
// How an arm is written down in a system description.
#include <algorithm>
#include <cmath>

#include "core/lists.h"
#include "dcnn/core/options.h"
#include "dcnn/data/rotation.h"
#include "dcnn/physics/chain.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kFarthest = 100.0;  // m, and rad

Eigen::VectorXd parse_numbers(Options& options, const std::string& key, std::size_t count,
                              const std::vector<double>& fallback) {
  const auto list = fallback.empty() ? options.get<std::vector<double>>(key)
                                     : options.get<std::vector<double>>(key, fallback);
  const bool good = list.size() == count && std::all_of(list.begin(), list.end(),
                                                        [](double v) { return std::isfinite(v); });
  if (!good) options.reject(key, "must be a list of ", count, " numbers");
  return Eigen::VectorXd::Map(list.data(), static_cast<Eigen::Index>(count));
}

/// As in a URDF: Rz(yaw)·Ry(pitch)·Rx(roll).
Matrix3d parse_turn(Options& options) {
  const Vector3d rpy = parse_numbers(options, "rpy_rad", 3, {0.0, 0.0, 0.0});
  return rotation_from_euler(rpy.reverse());
}

Json turn_json(const Matrix3d& R) { return json_list(euler_from_rotation(R).reverse()); }

ChainJoint parse_joint(const Json& json, const std::string& where, Exit exit) {
  Options options(json, where, exit);
  ChainJoint joint;
  joint.name = options.get<std::string>("name", "");
  joint.p = parse_numbers(options, "xyz_m", 3, {0.0, 0.0, 0.0});
  joint.R = parse_turn(options);
  joint.axis = parse_numbers(options, "axis", 3, {0.0, 0.0, 1.0});
  if (joint.axis.norm() < 1e-9) options.reject("axis", "has no direction");
  joint.axis.normalize();
  joint.slides = options.choice("moves", "turns", {"turns", "slides"}) == "slides";
  const Json body = options.raw("body");
  if (!body.is_null()) joint.body = parse_body(body, where + ": body", exit);
  options.finish();
  return joint;
}

Eigen::Vector4d parse_row(const Json& json, const Options& options) {
  const bool four = json.is_array() && json.size() == 4 &&
                    std::all_of(json.begin(), json.end(), [](const Json& v) {
                      return v.is_number() && std::abs(v.get<double>()) < kFarthest;
                    });
  if (!four) options.reject("dh", "must hold rows [a, alpha, d, theta0], not ", json.dump());
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>(),
          json[3].get<double>()};
}

void add_table(const Json& dh, bool modified, const Options& options, JointChain& chain) {
  if (!dh.is_array() || dh.empty()) options.reject("dh", "must be a list of [a, alpha, d, theta0]");
  Matrix3d R = Matrix3d::Identity();  // behind the last joint, before the next one's axis
  Vector3d p = Vector3d::Zero();
  for (const Json& entry : dh) {
    const Eigen::Vector4d row = parse_row(entry, options);
    const double a = row[0], d = row[2];
    const Matrix3d turn = rotation_about(Vector3d::UnitZ(), row[3]);
    const Matrix3d twist = rotation_about(Vector3d::UnitX(), row[1]);
    ChainJoint joint;
    joint.name = "joint" + std::to_string(chain.joints.size() + 1);
    if (modified) {
      joint.R = twist * turn;
      joint.p = twist * Vector3d(a, 0.0, d);
    } else {
      joint.R = R * turn;
      joint.p = p;
      p = Vector3d(a, 0.0, d);
      R = twist;
    }
    chain.joints.push_back(joint);
  }
  chain.flange_R = R;
  chain.flange_p = p;
}

}  // namespace

void set_gravity(const Json& arm, const std::string& where, Exit exit, JointChain& chain) {
  if (!arm.is_object() || !arm.contains("gravity_mps2")) return;
  Options options(Json{{"gravity_mps2", arm["gravity_mps2"]}}, where, exit);
  chain.gravity = parse_numbers(options, "gravity_mps2", 3, {});
}

JointChain parse_chain(const Json& json, const std::string& where, Exit exit) {
  Options options(json, where, exit);
  JointChain chain;
  chain.gravity = parse_numbers(options, "gravity_mps2", 3, {0.0, 0.0, -9.81});
  if (options.has("joints")) {
    const Json joints = options.raw("joints");
    if (!joints.is_array() || joints.empty()) options.reject("joints", "must be a list of joints");
    for (const Json& joint : joints) {
      const std::string place = where + ": joints[" + std::to_string(chain.joints.size()) + "]";
      chain.joints.push_back(parse_joint(joint, place, exit));
    }
    Options flange = options.child("flange");
    chain.flange_p = parse_numbers(flange, "xyz_m", 3, {0.0, 0.0, 0.0});
    chain.flange_R = parse_turn(flange);
    flange.finish();
  } else {
    const bool modified =
        options.choice("convention", "modified", {"modified", "standard"}) == "modified";
    add_table(options.raw("dh"), modified, options, chain);
  }
  options.finish();
  return chain;
}

Json to_json(const JointChain& chain) {
  Json joints = Json::array();
  for (const ChainJoint& joint : chain.joints) {
    Json one{{"name", joint.name},
             {"xyz_m", json_list(joint.p)},
             {"rpy_rad", turn_json(joint.R)},
             {"axis", json_list(joint.axis)},
             {"moves", joint.slides ? "slides" : "turns"}};
    if (joint.body) one["body"] = body_json(*joint.body);
    joints.push_back(one);
  }
  return {
      {"joints", joints},
      {"flange", {{"xyz_m", json_list(chain.flange_p)}, {"rpy_rad", turn_json(chain.flange_R)}}},
      {"gravity_mps2", json_list(chain.gravity)}};
}

BodyVector parse_body(const Json& json, const std::string& where, Exit exit) {
  Options options(json, where, exit);
  BodyVector body;
  body << options.get<double>("mass_kg"), parse_numbers(options, "moment_kgm", 3, {}),
      parse_numbers(options, "inertia_kgm2", 6, {});
  options.finish();
  return body;
}

Json body_json(const BodyVector& body) {
  return {{"mass_kg", body[0]},
          {"moment_kgm", json_list(body.segment<3>(1))},
          {"inertia_kgm2", json_list(body.tail<6>())}};
}

}  // namespace dcnn
