// SPDX-License-Identifier: Apache-2.0
#include "import/arm_pose.h"

#include <cmath>

#include "data/text.h"
#include "data/urdf_text.h"
#include "dcnn/core/error.h"

#ifdef DCNN_WITH_URDFDOM
#include <urdf_parser/urdf_parser.h>
#endif

namespace dcnn {

#ifdef DCNN_WITH_URDFDOM
namespace {

constexpr std::size_t kMostLinks = 1000;

struct ChainJoint {
  std::string name;
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< of the joint in its parent link
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  bool turns = false, slides = false;
};

Eigen::Isometry3d transform_of(const urdf::Pose& pose) {
  Eigen::Quaterniond q(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() << pose.position.x, pose.position.y, pose.position.z;
  return T;
}

ChainJoint chain_joint(const urdf::Joint& joint, const std::string& file) {
  require(!joint.mimic, Exit::kData, file, ": joint ", shown(joint.name),
          " follows another one (mimic), which is not supported in a chain");
  ChainJoint out{.name = joint.name};
  out.origin = transform_of(joint.parent_to_joint_origin_transform);
  out.turns = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS;
  out.slides = joint.type == urdf::Joint::PRISMATIC;
  require(out.turns || out.slides || joint.type == urdf::Joint::FIXED, Exit::kData, file,
          ": joint ", shown(joint.name), " is neither revolute, prismatic nor fixed");
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (out.turns || out.slides) {
    require(axis.norm() > 0.0 && axis.allFinite(), Exit::kData, file, ": joint ", shown(joint.name),
            " has no axis");
    out.axis = axis.normalized();
  }
  return out;
}

/// Joints from the base (the root where none is named) to the link.
std::vector<ChainJoint> read_chain(const ArmRule& rule) {
  const auto model = urdf::parseURDF(read_urdf_text(rule.urdf));
  require(model != nullptr, Exit::kData, rule.urdf, ": is no URDF that liburdfdom can read");
  auto link = model->getLink(rule.link);
  std::string all;
  for (const auto& [name, unused] : model->links_) all += (all.empty() ? "" : ", ") + name;
  require(link != nullptr, Exit::kData, rule.urdf, ": has no link ", shown(rule.link),
          "; say --link with one of: ", all);
  std::vector<ChainJoint> chain;
  while (link->parent_joint && link->name != rule.base) {
    require(chain.size() < kMostLinks, Exit::kData, rule.urdf, ": its links form a ring");
    chain.push_back(chain_joint(*link->parent_joint, rule.urdf));
    link = model->getLink(link->parent_joint->parent_link_name);
    require(link != nullptr, Exit::kData, rule.urdf, ": a joint has no parent link");
  }
  require(rule.base.empty() || link->name == rule.base, Exit::kData, rule.urdf, ": ",
          shown(rule.base), " is not on the way from ", shown(rule.link), " to the root ",
          shown(link->name));
  std::reverse(chain.begin(), chain.end());
  return chain;
}

/// The column of each moving joint: by its name, or by its number from 1 where the log numbers
/// them.
std::vector<Index> joint_columns(const std::vector<ChainJoint>& chain, const StreamTable& table,
                                 const std::string& file) {
  std::vector<Index> columns;
  int number = table.has("q:0") ? 0 : 1;
  for (const ChainJoint& joint : chain) {
    if (!joint.turns && !joint.slides) {
      columns.push_back(-1);
      continue;
    }
    Index at = table.find("q:" + joint.name);
    if (at < 0) at = table.find("q:" + std::to_string(number));
    require(at >= 0, Exit::kData, file, ": ", shown(table.stream), " has no angle of joint ",
            shown(joint.name), "; say --map q:", joint.name, "=CHANNEL");
    columns.push_back(at);
    ++number;
  }
  return columns;
}

Eigen::Isometry3d link_pose(const std::vector<ChainJoint>& chain, const std::vector<Index>& columns,
                            const StreamTable& table, Index row) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (std::size_t k = 0; k < chain.size(); ++k) {
    T = T * chain[k].origin;
    const double q = columns[k] < 0 ? 0.0 : table.values(row, columns[k]);
    if (chain[k].turns) T.rotate(Eigen::AngleAxisd(q, chain[k].axis));
    if (chain[k].slides) T.translate(q * chain[k].axis);
  }
  return T;
}

}  // namespace

void pose_from_joints(const ArmRule& rule, StreamTable* table, const std::string& file) {
  const auto is_angle = [](const std::string& column) { return column.starts_with("q:"); };
  if (std::none_of(table->columns.begin(), table->columns.end(), is_angle)) return;
  const auto chain = read_chain(rule);
  const auto columns = joint_columns(chain, *table, file);
  Eigen::MatrixXd pose(table->values.rows(), 7);
  for (Index row = 0; row < pose.rows(); ++row) {
    const Eigen::Isometry3d T = link_pose(chain, columns, *table, row);
    const Eigen::Quaterniond q(T.rotation());
    pose.row(row) << T.translation().transpose(), q.w(), q.x(), q.y(), q.z();
    if (row > 0 && pose.row(row).tail(4).dot(pose.row(row - 1).tail(4)) < 0.0) {
      pose.row(row).tail(4) *= -1.0;
    }
  }
  std::vector<std::string> of_joints;
  for (const std::string& column : table->columns) {
    if (is_angle(column) || column.starts_with("qd:") || column.starts_with("tau:")) {
      of_joints.push_back(column);
    }
  }
  table->drop(of_joints);
  const char* names[] = {"x", "y", "z", "qw", "qx", "qy", "qz"};
  for (Index k = 0; k < 7; ++k) table->set(names[k], pose.col(k));
}

#else

void pose_from_joints(const ArmRule&, StreamTable*, const std::string& file) {
  fail(Exit::kUsage, file,
       ": --urdf needs liburdfdom, which this build was made without; install "
       "liburdfdom-dev and build again");
}

#endif

}  // namespace dcnn
