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

/// What a joint carries: its link and all that is fixed to it, but for the branch that goes on.
void lump(const urdf::Link& link, const Place& at, BodyVector& body) {
  body += body_in_frame(body_of(link), at.R.transpose(), -(at.R.transpose() * at.p));
  for (const auto& child : link.child_links) {
    if (child->parent_joint->type != urdf::Joint::FIXED) continue;
    const Place step = place_of(child->parent_joint->parent_to_joint_origin_transform);
    lump(*child, {at.R * step.R, at.p + at.R * step.p}, body);
  }
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

JointChain read_urdf_chain(const std::filesystem::path& path, const std::string& wanted) {
  const std::string file = path.string();
  const auto model = urdf::parseURDF(read_urdf_text(path));
  require(model != nullptr, Exit::kData, file, ": is no URDF that liburdfdom can read");
  std::string tip = wanted;
  int most = 0;
  bool tied = false;
  if (tip.empty()) farthest(model->getRoot(), 0, most, tip, tied);
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
    if (joint.type == urdf::Joint::FIXED) continue;
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
    lump(*model->getLink(joint.child_link_name), Place(), body);
    if (body[0] > 0.0) next.body = body;
    chain.joints.push_back(next);
    at = Place();
  }
  require(!chain.joints.empty(), Exit::kData, file, ": no joint moves link '", tip, "'");
  chain.flange_R = at.R;
  chain.flange_p = at.p;
  return chain;
}

#else

JointChain read_urdf_chain(const std::filesystem::path& path, const std::string&) {
  fail(Exit::kData, path.string(),
       ": this build reads no URDF; install liburdfdom-dev and build again, or give the arm's DH "
       "table: --system");
}

#endif

}  // namespace dcnn
