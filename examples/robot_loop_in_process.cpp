// SPDX-License-Identifier: Apache-2.0
// A control loop with the model in the robot's own process (docs/use/run.md), beside
// robot_loop.cpp, which asks dcnn-run: the loop that keeps real time calls step(), which allocates,
// locks and throws nothing. Put your robot's calls in place of read() and use().
//   robot_loop_in_process MODEL [FALLBACK [SECONDS]]
#include <dcnn/runtime/open.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {

/// Pose and force at time t [s] of a robot that swings a tool of 0.5 kg; 5 N from outside along
/// base z after 1 s.
dcnn::OnlineSample read(double t) {
  dcnn::OnlineSample sample;
  sample.t = t;
  sample.position = {0.1 * std::sin(t), 0.0, 0.3};
  const double angle = 0.5 * std::sin(0.5 * t);
  sample.quaternion = {std::cos(0.5 * angle), std::sin(0.5 * angle), 0.0, 0.0};
  const double down = -0.5 * 9.81 + (t > 1.0 ? 5.0 : 0.0);  // N, turned into the sensor's frame
  sample.wrench << 0.0, down * std::sin(angle), down * std::cos(angle), 0.0, 0.0, 0.0;
  return sample;
}

void use(double t, const dcnn::OnlineResult& result) {
  const auto& f = result.external;
  std::printf("%.1f s: %s, external force %.2f %.2f %.2f N\n", t, dcnn::name_of(result.state), f[0],
              f[1], f[2]);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    std::puts("usage: robot_loop_in_process MODEL [FALLBACK [SECONDS]]");
    return 0;
  }
  dcnn::OnlineFiles files;
  files.model = argv[1];
  if (argc > 2) files.fallback = argv[2];
  dcnn::OnlineCompensator compensator = dcnn::open_compensator(
      files, {}, [](const std::string& note) { std::fprintf(stderr, "%s\n", note.c_str()); });
  const double dt = compensator.dt();
  const int cycles = static_cast<int>((argc > 3 ? std::atof(argv[3]) : 3.0) / dt);
  const int shown = static_cast<int>(0.5 / dt);
  for (int k = 0; k < cycles; ++k) {
    const double t = k * dt;
    const dcnn::OnlineResult& result = compensator.step(read(t));  // miss() where no sample came
    if (k % shown == 0) use(t, result);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "robot_loop_in_process: %s\n", error.what());
  return 1;
}
