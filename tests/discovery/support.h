// SPDX-License-Identifier: Apache-2.0
// Residuals with a law in them, for the tests of the discovery.
#pragma once

#include <cmath>
#include <functional>

#include "dcnn/discovery/discover.h"
#include "physics/support.h"

namespace dcnn::discovery {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A motion of 50 Hz and the force that the tool's simulator predicts for it.
struct Scene {
  Motion motion;
  MatrixXd load;
};

inline Scene scene(std::uint64_t seed, Index samples = 3000) {
  Json shape = example_trajectory();
  shape["tones"] = 6;
  shape["hz"] = {0.05, 1.2};
  Rng rng(seed);
  const ToolModel tool = example_tool();
  Scene made{
      motion_of(make_trajectory(Options(shape, "test", Exit::kUsage), {samples, 0.02, 0.0}, rng),
                tool),
      {}};
  ToolModel unbiased = tool;
  unbiased.bias.setZero();
  made.load = rigid_wrench(unbiased, made.motion).force;
  return made;
}

/// A force of S at every sample.
using Truth = std::function<Eigen::Vector3d(const Motion&, const MatrixXd& load, Index k)>;

inline MatrixXd force_of(const Scene& at, const Truth& truth) {
  MatrixXd force(at.motion.samples(), 3);
  for (Index k = 0; k < force.rows(); ++k) {
    force.row(k) = truth(at.motion, at.load, k).transpose();
  }
  return force;
}

inline MatrixXd white(Index rows, double deviation, std::uint64_t seed) {
  Rng rng(seed);
  MatrixXd noise(rows, 3);
  for (Index k = 0; k < rows; ++k) {
    for (Index j = 0; j < 3; ++j) noise(k, j) = deviation * rng.normal();
  }
  return noise;
}

/// The residual as a problem whose noise has this deviation in every channel.
inline Problem problem_of(const Scene& at, const MatrixXd& residual, double deviation) {
  Problem problem;
  problem.records = {{&at.motion, at.load}};
  problem.whiten = [deviation](const std::vector<MatrixXd>& force) {
    return VectorXd(force[0].reshaped() / deviation);
  };
  problem.transposed = [deviation](const VectorXd& rows) {
    return std::vector<MatrixXd>{rows.reshaped(rows.size() / 3, 3) / deviation};
  };
  for (std::size_t j = 0; j < 3; ++j) {
    for (Index k = 0; k < residual.rows(); ++k) problem.rows.push_back({0, j, at.motion.t(k)});
  }
  problem.residual = problem.whiten({residual});
  problem.known.resize(problem.residual.size(), 0);
  return problem;
}

/// What the laws push with.
inline MatrixXd prediction(const Scene& at, const std::vector<Discovered>& laws) {
  Wrench wrench{at.load, MatrixXd(0, 3)};
  for (const Discovered& found : laws) {
    law::LawRun run(found.law);
    for (Index k = 0; k < at.motion.samples(); ++k) {
      const law::Sample now =
          law::sample_of(at.motion, k, at.load.row(k), found.law.structure.signals);
      wrench.force.row(k) += run.step(now, at.motion.dt, k == 0).transpose();
    }
  }
  return wrench.force - at.load;
}

}  // namespace dcnn::discovery
