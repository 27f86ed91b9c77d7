// SPDX-License-Identifier: Apache-2.0
// The chain's regressor against the DH form, and against orocos-kdl where it is installed.
#include <gtest/gtest.h>

#include "data/testing.h"
#include "dcnn/core/parallel.h"
#include "dcnn/core/random.h"
#include "dcnn/identification/urdf.h"
#include "dcnn/physics/chain.h"

#ifdef DCNN_WITH_KDL
#include <kdl/chain.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#endif

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

MatrixXd random_rows(Index rows, Index columns, Rng& rng) {
  MatrixXd m(rows, columns);
  for (double& v : m.reshaped()) v = rng.normal();
  return m;
}

Matrix3d random_rotation(Rng& rng) {
  Eigen::Quaterniond q(rng.normal(), rng.normal(), rng.normal(), rng.normal());
  return q.normalized().toRotationMatrix();
}

/// Seven joints about any axes, one of which slides.
JointChain random_chain(Rng& rng) {
  JointChain chain;
  for (int k = 0; k < 7; ++k) {
    ChainJoint joint;
    joint.R = random_rotation(rng);
    joint.p = 0.3 * Vector3d(rng.normal(), rng.normal(), rng.normal());
    joint.axis = Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    joint.slides = k == 3;
    const Vector3d c = 0.1 * Vector3d(rng.normal(), rng.normal(), rng.normal());
    const Matrix3d R = random_rotation(rng);
    const Matrix3d I = R * Vector3d(0.02, 0.03, 0.04).asDiagonal() * R.transpose();
    BodyVector at_com;
    at_com << 1.0 + rng.uniform(), 0, 0, 0, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2);
    joint.body = body_in_frame(at_com, Matrix3d::Identity(), -c);
    chain.joints.push_back(joint);
  }
  return chain;
}

VectorXd bodies_of(const JointChain& chain) {
  VectorXd all(10 * static_cast<Index>(chain.joints.size()));
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    all.segment(10 * static_cast<Index>(k), 10) = *chain.joints[k].body;
  }
  return all;
}

/// A frame turned and moved as Denavit and Hartenberg's rows say, by homogeneous transformations.
TEST(JointChain, OfADhTableHasTheFramesOfTheTableInBothConventions) {
  const std::vector<std::vector<double>> rows{
      {0.1, 0.7, 0.3, 0.2}, {0.4, -1.1, 0.1, -0.5}, {0.2, 0.4, 0.2, 1.0}};
  const double q[] = {0.3, -0.8, 1.4};
  for (const std::string convention : {"modified", "standard"}) {
    const JointChain chain =
        parse_chain({{"convention", convention}, {"dh", rows}}, "test", Exit::kData);
    Eigen::Isometry3d table = Eigen::Isometry3d::Identity(), here = table;
    for (std::size_t k = 0; k < 3; ++k) {
      Eigen::Isometry3d turn = Eigen::Isometry3d::Identity(), twist = turn;
      turn.rotate(Eigen::AngleAxisd(q[k] + rows[k][3], Vector3d::UnitZ()));
      turn.translate(Vector3d(0.0, 0.0, rows[k][2]));
      twist.rotate(Eigen::AngleAxisd(rows[k][1], Vector3d::UnitX()));
      twist.translate(Vector3d(rows[k][0], 0.0, 0.0));
      table = table * (convention == "modified" ? twist * turn : turn * twist);
      Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
      step.translate(chain.joints[k].p);
      step.rotate(chain.joints[k].R);
      step.rotate(Eigen::AngleAxisd(q[k], chain.joints[k].axis));
      here = here * step;
    }
    here.translate(chain.flange_p);
    here.rotate(chain.flange_R);
    EXPECT_LT((table.matrix() - here.matrix()).cwiseAbs().maxCoeff(), 1e-14) << convention;
  }
}

TEST(JointChain, IsReadBackAsItWasWritten) {
  Rng rng(9);
  JointChain chain = random_chain(rng);
  chain.flange_R = random_rotation(rng);
  chain.flange_p = {0.1, 0.2, -0.3};
  const JointChain back = parse_chain(to_json(chain), "test", Exit::kData);
  const auto count = static_cast<Index>(chain.joints.size());
  const MatrixXd q = random_rows(5, count, rng), v = random_rows(5, count, rng),
                 a = random_rows(5, count, rng);
  ASSERT_TRUE(back.bodies());
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    const VectorXd there = chain_regressor(back, q, v, a, j) * *back.bodies();
    EXPECT_LT((chain_regressor(chain, q, v, a, j) * bodies_of(chain) - there).cwiseAbs().maxCoeff(),
              1e-12);
  }
  EXPECT_LT((flange_to_link(chain) - flange_to_link(back)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(JointChain, ABodySeenFromAnotherFrameAndBackIsTheSame) {
  Rng rng(8);
  const JointChain chain = random_chain(rng);
  const Matrix3d R = random_rotation(rng);
  const Vector3d p(0.1, -0.2, 0.3);
  const BodyVector there = body_in_frame(*chain.joints[0].body, R, p);
  const BodyVector back = body_in_frame(there, R.transpose(), -(R.transpose() * p));
  EXPECT_LT((back - *chain.joints[0].body).norm(), 1e-14);
  // A point mass: about the new origin it is m (|r|² 1 - r r^T).
  BodyVector point = BodyVector::Zero();
  point[0] = 2.0;
  const BodyVector moved = body_in_frame(point, Matrix3d::Identity(), Vector3d(0.0, 0.0, 0.5));
  EXPECT_NEAR(moved[3], -1.0, 1e-15);
  EXPECT_NEAR(moved[4], 0.5, 1e-15);
  EXPECT_NEAR(moved[9], 0.0, 1e-15);
}

#ifdef DCNN_WITH_KDL
KDL::Frame frame_of(const Matrix3d& R, const Vector3d& p) {
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1),
                        R(2, 2)),
          KDL::Vector(p.x(), p.y(), p.z())};
}

/// KDL's segment is a joint and the frame at its far end, where its inertia is given: with the
/// joint's place as a fixed segment before it, that frame is the joint's own.
KDL::Chain kdl_of(const JointChain& chain) {
  KDL::Chain out;
  for (const ChainJoint& joint : chain.joints) {
    out.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), frame_of(joint.R, joint.p)));
    const BodyVector& b = *joint.body;
    const Vector3d c = b.segment<3>(1) / b[0];
    const BodyVector com = body_in_frame(b, Matrix3d::Identity(), c);
    const KDL::RigidBodyInertia inertia(
        b[0], KDL::Vector(c.x(), c.y(), c.z()),
        KDL::RotationalInertia(com[4], com[7], com[9], com[5], com[6], com[8]));
    const KDL::Vector axis(joint.axis.x(), joint.axis.y(), joint.axis.z());
    out.addSegment(
        KDL::Segment(KDL::Joint(KDL::Vector::Zero(), axis,
                                joint.slides ? KDL::Joint::TransAxis : KDL::Joint::RotAxis),
                     KDL::Frame::Identity(), inertia));
  }
  return out;
}
#endif

TEST(JointChain, HasTheTorquesOfOrocosKdl) {
#ifdef DCNN_WITH_KDL
  Rng rng(11);
  const JointChain chain = random_chain(rng);
  const KDL::Chain other = kdl_of(chain);
  KDL::ChainIdSolver_RNE solver(other, KDL::Vector(0.0, 0.0, -9.81));
  const VectorXd bodies = bodies_of(chain);
  for (int trial = 0; trial < 10; ++trial) {
    const MatrixXd q = random_rows(1, 7, rng), v = random_rows(1, 7, rng),
                   a = random_rows(1, 7, rng);
    KDL::JntArray kq(7), kv(7), ka(7), torques(7);
    kq.data = q.transpose();
    kv.data = v.transpose();
    ka.data = a.transpose();
    ASSERT_EQ(solver.CartToJnt(kq, kv, ka, KDL::Wrenches(other.getNrOfSegments()), torques), 0);
    for (std::size_t joint = 0; joint < 7; ++joint) {
      const double ours = (chain_regressor(chain, q, v, a, joint) * bodies)(0);
      EXPECT_NEAR(ours, torques(static_cast<unsigned>(joint)), 1e-9 * (1.0 + std::abs(ours)));
    }
  }
#else
  GTEST_SKIP() << "without liborocos-kdl-dev";
#endif
}

constexpr const char* kUrdf = R"(<robot name="two"><link name="base"/>
<joint name="a" type="revolute"><parent link="base"/><child link="one"/>
 <origin xyz="0 0 0.3" rpy="0 0.5 0"/><axis xyz="0 0 2"/><limit effort="1" velocity="1"/></joint>
<link name="one"><inertial><origin xyz="0 0 0.1" rpy="0 0 1.5707963267948966"/><mass value="2"/>
 <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.03"/></inertial></link>
<joint name="f" type="fixed"><parent link="one"/><child link="lump"/><origin xyz="0 0 0.5"/></joint>
<link name="lump"><inertial><mass value="1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
<joint name="b" type="prismatic"><parent link="lump"/><child link="two"/><axis xyz="1 0 0"/>
 <limit lower="0" upper="1" effort="1" velocity="1"/></joint><link name="two"/>
<joint name="g" type="fixed"><parent link="two"/><child link="tool0"/><origin xyz="0 0.2 0"/></joint>
<link name="tool0"/></robot>)";

TEST(JointChain, OfAUrdfLumpsWhatIsFixed) {
  const auto file = testing::temporary_file("two.urdf", kUrdf);
  JointChain chain;
  try {
    chain = read_urdf_chain(file, "tool0");
  } catch (const Error& error) {
    if (testing::contains(error.what(), "reads no URDF")) GTEST_SKIP() << error.what();
    throw;
  }
  ASSERT_EQ(chain.joints.size(), 2U);
  EXPECT_EQ(chain.joints[0].name, "a");
  EXPECT_LT((chain.joints[0].axis - Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_TRUE(chain.joints[1].slides);
  EXPECT_NEAR(chain.joints[1].p.z(), 0.5, 1e-15);
  EXPECT_NEAR(chain.flange_p.y(), 0.2, 1e-15);
  ASSERT_TRUE(chain.joints[0].body.has_value());
  const BodyVector body = *chain.joints[0].body;
  EXPECT_NEAR(body[0], 3.0, 1e-12);
  EXPECT_NEAR(body[3], 2.0 * 0.1 + 1.0 * 0.5, 1e-12);
  EXPECT_NEAR(body[4], 0.02 + 2.0 * 0.01 + 0.25, 1e-12);  // turned by 90 degrees about z
  EXPECT_FALSE(chain.joints[1].body.has_value());
  EXPECT_THROW(read_urdf_chain(file, "nowhere"), Error);
  // What no axis is called by is held at zero, and carried.
  const JointChain first = read_urdf_chain(file, "tool0", {"a"});
  ASSERT_EQ(first.joints.size(), 1U);
  EXPECT_NEAR(first.flange_p.z(), 0.5, 1e-15);
  const JointChain second = read_urdf_chain(file, "", {"b"});
  ASSERT_EQ(second.joints.size(), 1U);
  EXPECT_TRUE(second.joints[0].slides);
  EXPECT_EQ(read_urdf_chain(file, "tool0", {"joint1", "joint2"}).joints.size(), 2U);
  EXPECT_THROW(read_urdf_chain(file, "tool0", {"b", "a"}), Error);
  EXPECT_THROW(read_urdf_chain(file, "tool0", {"a", "c"}), Error);
  EXPECT_THROW(read_urdf_chain(testing::temporary_file("bad.urdf", "<robot"), ""), Error);
}

}  // namespace
}  // namespace dcnn
