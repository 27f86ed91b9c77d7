// SPDX-License-Identifier: Apache-2.0
// Laws whose memory has many sizes, and a contact in the plane that gives way before it slides.
#include <gtest/gtest.h>

#include "discovery/support.h"

namespace dcnn::discovery {
namespace {

constexpr double kNoise = 0.01;  // N, deviation of a block's noise

double rms_error(const Scene& at, const std::vector<Discovered>& laws, const MatrixXd& truth) {
  const MatrixXd error = prediction(at, laws) - truth;
  return std::sqrt(error.squaredNorm() / static_cast<double>(error.size()));
}

std::string all(const std::vector<Discovered>& laws) {
  std::string text;
  for (const Discovered& found : laws) text += law::expression(found.law) + "\n";
  return text;
}

TEST(DiscoverSpectra, ATubeThatRelaxesWithThreeTimes) {
  // A cubic spring along the base's x of which 0.8 relax, by Euler's steps of 0.2 ms.
  const auto tube = [](const Scene& at) {
    const double centre = at.motion.p_B.col(0).mean(), times[] = {0.15, 1.2, 9.0},
                 shares[] = {0.3, 0.25, 0.25};
    const auto spring = [&](double x) {
      const double u = (x - centre) / 0.1;
      return u + 0.5 * u * u * u;
    };
    MatrixXd force(at.motion.samples(), 3);
    double relaxed[3] = {};
    for (double& s : relaxed) s = spring(at.motion.p_B(0, 0));
    for (Index k = 0; k < force.rows(); ++k) {
      const double now = spring(at.motion.p_B(k, 0)),
                   before = spring(at.motion.p_B(std::max<Index>(0, k - 1), 0));
      double f = now;
      for (int i = 0; i < 3; ++i) {
        for (int part = 0; part < 100; ++part) {
          const double q = before + 0.01 * part * (now - before);
          relaxed[i] += 0.01 * at.motion.dt * (q - relaxed[i]) / times[i];
        }
        f -= shares[i] * relaxed[i];
      }
      force.row(k) = -0.5 * f * at.motion.R_BS[static_cast<std::size_t>(k)].row(0);
    }
    return force;
  };
  const Scene at = scene(3, 2500), other = scene(77, 2500);
  const auto laws = discover(problem_of(at, tube(at) + white(2500, kNoise, 43), kNoise));
  ASSERT_FALSE(laws.empty());
  EXPECT_LE(rms_error(at, laws, tube(at)), 0.5 * kNoise) << all(laws);
  EXPECT_LE(rms_error(other, laws, tube(other)), kNoise) << all(laws);
}

TEST(DiscoverSpectra, AChainOfLinksThatSlipOneAfterTheOther) {
  // Six springs behind plays of uneven widths (Prandtl and Ishlinskii).
  const auto chain = [](const Scene& at) {
    const double widths[] = {0.004, 0.01, 0.018, 0.03, 0.045, 0.07},
                 gains[] = {2.0, 3.0, 1.5, 2.5, 2.0, 3.0};
    double s[6];
    MatrixXd force(at.motion.samples(), 3);
    for (Index k = 0; k < force.rows(); ++k) {
      const double q = at.motion.p_B(k, 1);
      double f = 0.0;
      for (int i = 0; i < 6; ++i) {
        s[i] = k == 0 ? q : std::clamp(s[i], q - widths[i], q + widths[i]);
        f += gains[i] * s[i];
      }
      force.row(k) = -0.3 * f * at.motion.R_BS[static_cast<std::size_t>(k)].row(1);
    }
    return force;
  };
  const Scene at = scene(3, 2500), other = scene(77, 2500);
  const auto laws = discover(problem_of(at, chain(at) + white(2500, kNoise, 45), kNoise));
  ASSERT_FALSE(laws.empty());
  // Plays of even widths stand for uneven ones: no better than to about the noise.
  EXPECT_LE(rms_error(other, laws, chain(other)), 1.2 * kNoise) << all(laws);
}

TEST(DiscoverSpectra, AForceThatFollowsALoggedColumn) {
  // A line under pressure, which pushes along the tool with its power 1.5, 0.4 s late.
  const auto with_pressure = [](Scene at, double phase) {
    VectorXd pressure(at.motion.samples());
    for (Index k = 0; k < pressure.size(); ++k) {
      const double t = 0.02 * static_cast<double>(k);
      pressure(k) = 2.0 + std::sin(0.9 * t + phase) + 0.7 * std::sin(2.3 * t);
    }
    at.motion.signals = {{"other", VectorXd(pressure.reverse())}, {"load", pressure}};
    return at;
  };
  const auto pushed = [](const Scene& at) {
    MatrixXd force = MatrixXd::Zero(at.motion.samples(), 3);
    const VectorXd& pressure = at.motion.signals[1].values;
    double s = pressure(0);
    for (Index k = 0; k < force.rows(); ++k) {
      for (int part = 0; k > 0 && part < 100; ++part) {
        s += 0.01 * 0.02 / 0.4 *
             (pressure(k - 1) + 0.01 * part * (pressure(k) - pressure(k - 1)) - s);
      }
      force(k, 2) = 0.1 * std::pow(s, 1.5);
    }
    return force;
  };
  const Scene at = with_pressure(scene(3, 2500), 0.0), other = with_pressure(scene(77, 2500), 1.0);
  const auto laws = discover(problem_of(at, pushed(at) + white(2500, kNoise, 49), kNoise));
  ASSERT_FALSE(laws.empty());
  EXPECT_EQ(laws[0].law.structure.signals, std::vector<std::string>{"load"});
  EXPECT_NE(law::words(laws[0].law).find("the logged load"), std::string::npos);
  EXPECT_LE(rms_error(other, laws, pushed(other)), 0.32 * kNoise) << all(laws);
  const auto again = refitted(problem_of(at, pushed(at), kNoise), laws);
  ASSERT_EQ(again.size(), laws.size());
  EXPECT_EQ(again[0].law.structure, laws[0].law.structure);
}

TEST(DiscoverSpectra, ADrapeThatStretchesBeforeItSlips) {
  // Elastic up to 8 mm in any direction of the base, then it slips (von Mises, return mapping).
  const auto drape = [](const Scene& at) {
    MatrixXd force(at.motion.samples(), 3);
    Eigen::Vector3d stretch = Eigen::Vector3d::Zero();
    for (Index k = 0; k < force.rows(); ++k) {
      const Eigen::Vector3d p = at.motion.p_B.row(k),
                            before = at.motion.p_B.row(std::max<Index>(0, k - 1));
      stretch += p - before;
      if (stretch.norm() > 0.008) stretch *= 0.008 / stretch.norm();
      force.row(k) =
          -40.0 * (at.motion.R_BS[static_cast<std::size_t>(k)].transpose() * stretch).transpose();
    }
    return force;
  };
  const Scene at = scene(3, 2500), other = scene(77, 2500);
  const auto laws = discover(problem_of(at, drape(at) + white(2500, kNoise, 47), kNoise));
  ASSERT_FALSE(laws.empty());
  EXPECT_NE(law::expression(laws[0].law).find("presliding"), std::string::npos) << all(laws);
  EXPECT_LE(rms_error(other, laws, drape(other)), 2.0 * kNoise) << all(laws);
}

}  // namespace
}  // namespace dcnn::discovery
