// SPDX-License-Identifier: Apache-2.0
#include "design/joints.h"

#include "dcnn/data/rotation.h"

namespace dcnn::design {
FlangeState flange_state(const JointChain& chain, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd) {
  FlangeState s{Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                Eigen::Vector3d::Zero(),     Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  // A point fixed to the frame at p: v += w x Rp, a += dw x Rp + w x (w x Rp), with w, dw in the
  // frame.
  const auto carry = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d spin = s.w_E.cross(p);
    s.p += s.R * p;
    s.v += s.R * spin;
    s.a += s.R * (s.dw_E.cross(p) + s.w_E.cross(spin));
  };
  const auto turn = [&](const Eigen::Matrix3d& R) {
    s.R = s.R * R;
    s.w_E = R.transpose() * s.w_E;
    s.dw_E = R.transpose() * s.dw_E;
  };
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    const ChainJoint& joint = chain.joints[k];
    const auto i = static_cast<Eigen::Index>(k);
    carry(joint.p);
    turn(joint.R);
    if (joint.slides) {
      carry(joint.axis * q(i));
      s.v += s.R * joint.axis * qd(i);
      s.a += s.R * (joint.axis * qdd(i) + 2.0 * s.w_E.cross(joint.axis) * qd(i));
    } else {
      turn(rotation_about(joint.axis, q(i)));
      s.dw_E += joint.axis * qdd(i) + s.w_E.cross(joint.axis) * qd(i);
      s.w_E += joint.axis * qd(i);
    }
  }
  carry(chain.flange_p);
  turn(chain.flange_R);
  return s;
}

Eigen::VectorXd pose_of(const JointChain& chain, const Eigen::VectorXd& q) {
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(q.size());
  const FlangeState s = flange_state(chain, q, rest, rest);
  Eigen::VectorXd pose(6);
  pose << s.p, euler_from_rotation(s.R);
  return pose;
}

}  // namespace dcnn::design
