// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "data/urdf_text.h"
#include "dcnn/core/error.h"
#include "dcnn/identification/urdf.h"

#ifdef DCNN_WITH_URDFDOM
#include <urdf_parser/urdf_parser.h>
#endif

namespace dcnn {

#ifdef DCNN_WITH_URDFDOM
namespace {

struct Place {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
};

Place place_of(const urdf::Pose& pose) {
  double x = 0, y = 0, z = 0, w = 1;
  pose.rotation.getQuaternion(x, y, z, w);
  return {Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix(),
          {pose.position.x, pose.position.y, pose.position.z}};
}

/// The body of a link in the link's frame.
BodyVector body_of(const urdf::Link& link) {
  BodyVector body = BodyVector::Zero();
  if (!link.inertial) return body;
  const urdf::Inertial& in = *link.inertial;
  body[0] = in.mass;
  body.tail<6>() << in.ixx, in.ixy, in.ixz, in.iyy, in.iyz, in.izz;
  // From the frame of the centre of mass to the link's.
  const Place at = place_of(in.origin);
  return body_in_frame(body, at.R.transpose(), -(at.R.transpose() * at.p));
}

/// Which joints move; empty: all that are not fixed.
using Moving = std::set<std::string>;

bool is_held(const urdf::Joint& joint, const Moving& moving) {
  return joint.type == urdf::Joint::FIXED || (!moving.empty() && !moving.contains(joint.name));
}

/// What a joint carries: its link and all that is held to it, but for the branch that goes on.
void lump(const urdf::Link& link, const Place& at, const Moving& moving, BodyVector& body) {
  body += body_in_frame(body_of(link), at.R.transpose(), -(at.R.transpose() * at.p));
  for (const auto& child : link.child_links) {
    if (!is_held(*child->parent_joint, moving)) continue;
    const Place step = place_of(child->parent_joint->parent_to_joint_origin_transform);
    lump(*child, {at.R * step.R, at.p + at.R * step.p}, moving, body);
  }
}

/// The names of axes that are joints of the model; none where no axis is called as a joint is.
Moving moving_joints(const urdf::ModelInterface& model, const std::vector<std::string>& axes,
                     const std::string& file) {
  Moving moving;
  std::string unknown;
  for (const std::string& axis : axes) {
    if (model.getJoint(axis) != nullptr) {
      moving.insert(axis);
    } else if (unknown.empty()) {
      unknown = axis;
    }
  }
  require(moving.empty() || unknown.empty(), Exit::kData, file, ": has no joint '", unknown,
          "'; call the axes of --system as its joints are called");
  return moving;
}

void check_order(const JointChain& chain, const std::vector<std::string>& axes,
                 const std::string& file, const std::string& tip) {
  std::string names;
  bool same = chain.joints.size() == axes.size();
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    same = same && chain.joints[k].name == axes[k];
    names += (k == 0 ? "" : ", ") + chain.joints[k].name;
  }
  require(same, Exit::kData, file, ": the joints to link '", tip, "' are ", names,
          ", and the axes of --system are not these in this order");
}

/// The link farthest from the root behind movable joints, by the number of those.
void farthest(const urdf::LinkConstSharedPtr& link, int joints, int& most, std::string& tip,
              bool& tied) {
  if (joints > most) {
    most = joints;
    tip = link->name;
    tied = false;
  } else if (joints == most && joints > 0 && link->parent_joint->type != urdf::Joint::FIXED) {
    tied = true;
  }
  for (const auto& child : link->child_links) {
    const bool moves = child->parent_joint->type != urdf::Joint::FIXED;
    farthest(child, joints + (moves ? 1 : 0), most, tip, tied);
  }
}

}  // namespace

JointChain read_urdf_chain(const std::filesystem::path& path, const std::string& wanted,
                           const std::vector<std::string>& axes) {
  const std::string file = path.string();
  const auto model = urdf::parseURDF(read_urdf_text(path));
  require(model != nullptr, Exit::kData, file, ": is no URDF that liburdfdom can read");
  const Moving moving = moving_joints(*model, axes, file);
  std::string tip = wanted;
  int most = 0;
  bool tied = false;
  if (tip.empty()) farthest(model->getRoot(), 0, most, tip, tied);
  if (tied && !moving.empty()) {
    tip = model->getJoint(axes.back())->child_link_name;
    tied = false;
  }
  require(!tied, Exit::kData, file, ": has several ends; name the arm's last link: --tip LINK");
  auto link = model->getLink(tip);
  require(link != nullptr, Exit::kData, file, ": has no link '", tip, "'; name one: --tip LINK");
  std::vector<urdf::JointConstSharedPtr> path_joints;
  for (; link->parent_joint; link = link->getParent()) path_joints.push_back(link->parent_joint);
  JointChain chain;
  Place at;  // from the last movable joint
  for (auto it = path_joints.rbegin(); it != path_joints.rend(); ++it) {
    const urdf::Joint& joint = **it;
    const Place step = place_of(joint.parent_to_joint_origin_transform);
    at = {at.R * step.R, at.p + at.R * step.p};
    if (is_held(joint, moving)) continue;
    ChainJoint next;
    next.slides = joint.type == urdf::Joint::PRISMATIC;
    require(
        next.slides || joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS,
        Exit::kData, file, ": joint '", joint.name, "' neither turns nor slides");
    next.name = joint.name;
    next.R = at.R;
    next.p = at.p;
    next.axis = Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z);
    require(next.axis.norm() > 1e-9, Exit::kData, file, ": joint '", joint.name, "' has no axis");
    next.axis.normalize();
    BodyVector body = BodyVector::Zero();
    lump(*model->getLink(joint.child_link_name), Place(), moving, body);
    if (body[0] > 0.0) next.body = body;
    chain.joints.push_back(next);
    at = Place();
  }
  require(!chain.joints.empty(), Exit::kData, file, ": no joint moves link '", tip, "'");
  if (!moving.empty()) check_order(chain, axes, file, tip);
  chain.flange_R = at.R;
  chain.flange_p = at.p;
  return chain;
}

#else

JointChain read_urdf_chain(const std::filesystem::path& path, const std::string&,
                           const std::vector<std::string>&) {
  fail(Exit::kData, path.string(),
       ": this build reads no URDF; install liburdfdom-dev and build again, or give the arm's DH "
       "table: --system");
}

#endif

}  // namespace dcnn
