// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "dcnn/experiment/teleop_report.h"
#include "experiment/svg_marks.h"

namespace dcnn {
namespace {

constexpr double kWidth = 720, kHeight = 360;
constexpr double kAxis = 0.12;  // m, length of a drawn axis

/// Axonometric projection of a point [m] about `origin` [px], z upwards.
Point project(Point origin, const Eigen::Vector3d& p) {
  constexpr double kScale = 260;  // px/m
  return {origin.x + kScale * (0.87 * p.x() - 0.50 * p.y()),
          origin.y - kScale * (p.z() - 0.25 * p.x() - 0.43 * p.y())};
}

std::string axes_of(Point origin, const Eigen::Matrix4d& T, const std::string& name) {
  const Eigen::Vector3d at = T.topRightCorner<3, 1>();
  const Point from = project(origin, at);
  std::string svg;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d tip = at + kAxis * T.block<3, 1>(0, k);
    const Point to = project(origin, tip);
    svg += line(from, to, stroke(static_cast<std::size_t>(k)) + " stroke-width=\"2\"");
    svg += words({to.x + 3, to.y}, std::string(1, "xyz"[k]), "font-size=\"12\"");
  }
  return svg + words({from.x - 10, from.y + 40}, name, "font-size=\"12\"");  // below the tip of y
}

/// A frame and, by a dashed line, another one in it; one pair of axes where they are the same.
std::string pair_of(Point origin, const std::string& base, const Eigen::Matrix4d& T,
                    const std::string& name) {
  const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
  if (T.isApprox(identity)) return axes_of(origin, identity, base + " = " + name);
  return line(project(origin, Eigen::Vector3d::Zero()), project(origin, T.topRightCorner<3, 1>()),
              "stroke=\"#888\" stroke-dasharray=\"4 3\"") +
         axes_of(origin, identity, base) + axes_of(origin, T, name);
}

}  // namespace

std::string frames_svg(const TeleopConfig& config) {
  std::string body = box({0, 0}, kWidth, kHeight, "fill=\"#fff\"");
  body += pair_of({90, 270}, "master M", config.T_master_slave, "slave") +
          pair_of({330, 290}, "robot base B", config.T_base_tip, "tip E") +
          pair_of({520, 290}, "workspace W", config.T_workspace_camera, "camera");
  return svg_document(kWidth, kHeight, "Frames of the set-up", body);
}

}  // namespace dcnn
