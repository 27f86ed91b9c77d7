// SPDX-License-Identifier: Apache-2.0
// How a robot's control loop uses dcnn-run (docs/use/run.md): the robot is a mock that swings a tool
// and touches something after a second. Put your robot's calls in place of the class MockRobot.
//   robot_loop SECRET.key [OWN_ADDRESS DCNN_RUN_ADDRESS [SECONDS]]
#include <dcnn/runtime/udp.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

/// A robot with a wrist sensor: pose and force at 500 Hz.
class MockRobot {
 public:
  /// Waits for the next control tick (KUKA FRI: ClientApplication::step(); libfranka: the control
  /// callback; UR RTDE: receive(); ROS 2: update() of a controller).
  void wait() {
    next_.tv_nsec += 2000000;
    if (next_.tv_nsec >= 1000000000) {
      next_.tv_nsec -= 1000000000;
      ++next_.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next_, nullptr);
    t_ += 0.002;
  }

  dcnn::OnlineSample read() const {
    dcnn::OnlineSample sample;
    sample.t = t_;
    sample.position = {0.1 * std::sin(t_), 0.0, 0.3};
    const double half = 0.25 * std::sin(0.5 * t_);
    sample.quaternion = {std::cos(half), std::sin(half), 0.0, 0.0};
    // Weight of 0.5 kg, turned into the sensor's frame; 5 N from outside along base z after 1 s.
    const double down = -0.5 * 9.81 + (t_ > 1.0 ? 5.0 : 0.0);
    const double angle = 2.0 * half;
    sample.wrench << 0.0, down * std::sin(angle), down * std::cos(angle), 0.0, 0.0, 0.0;
    return sample;
  }

  /// What the haptic device or the controller does with the force, N in the robot's base.
  void use(const Eigen::Vector3d& force) { felt_ = force; }
  const Eigen::Vector3d& felt() const { return felt_; }

  MockRobot() { clock_gettime(CLOCK_MONOTONIC, &next_); }

 private:
  timespec next_{};
  double t_ = 0.0;
  Eigen::Vector3d felt_ = Eigen::Vector3d::Zero();
};

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    std::puts("usage: robot_loop SECRET.key [OWN_ADDRESS DCNN_RUN_ADDRESS [SECONDS]]");
    return 0;
  }
  dcnn::RobotLink link(argc > 3 ? argv[2] : "5302", argc > 3 ? argv[3] : "5301",
                       dcnn::read_packet_key(argv[1]));
  if (!link.connect(10.0)) {
    std::fputs("robot_loop: dcnn-run does not answer\n", stderr);
    return 1;
  }
  MockRobot robot;
  const int cycles = static_cast<int>(500.0 * (argc > 4 ? std::atof(argv[4]) : 3.0));
  for (int k = 0; k < cycles; ++k) {
    robot.wait();
    const auto asked = link.send(robot.read());
    // At most half a cycle: a late answer is the next cycle's, and the guard has told us before
    // whenever something is wrong.
    const double deadline = dcnn::monotonic_seconds() + 0.001;
    while (const auto answer = link.receive(deadline)) {
      if (answer->result.state == dcnn::RunState::kFault) {
        robot.use(Eigen::Vector3d::Zero());  // stop; a person looks, then sends rearm
      } else {
        robot.use(answer->result.external.head<3>());
      }
      if (answer->answers == asked) break;
    }
    if (k % 250 == 0) {
      const auto& f = robot.felt();
      std::printf("%.1f s: external force %.2f %.2f %.2f N\n", 0.002 * k, f[0], f[1], f[2]);
    }
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "robot_loop: %s\n", error.what());
  return 1;
}
