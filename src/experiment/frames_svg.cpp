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
  return svg + words({from.x - 10, from.y + 18}, name, "font-size=\"12\"");
}

std::string link(Point origin, const Eigen::Matrix4d& T) {
  return line(project(origin, Eigen::Vector3d::Zero()), project(origin, T.topRightCorner<3, 1>()),
              "stroke=\"#888\" stroke-dasharray=\"4 3\"");
}

}  // namespace

std::string frames_svg(const TeleopConfig& config) {
  const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
  const Point master{90, 270}, slave{330, 290}, workspace{520, 290};
  std::string body = box({0, 0}, kWidth, kHeight, "fill=\"#fff\"");
  body += link(master, config.T_master_slave) + axes_of(master, identity, "master M") +
          axes_of(master, config.T_master_slave, "slave in M");
  body += link(slave, config.T_base_tip) + axes_of(slave, identity, "robot base B") +
          axes_of(slave, config.T_base_tip, "tip E");
  body += link(workspace, config.T_workspace_camera) + axes_of(workspace, identity, "workspace W") +
          axes_of(workspace, config.T_workspace_camera, "camera");
  return svg_document(kWidth, kHeight, "Frames of the set-up", body);
}

}  // namespace dcnn
