// SPDX-License-Identifier: Apache-2.0
// Laws of the hidden effects along a high-rate path, written from their published equations.
#pragma once

#include "conceal/world.h"

namespace dcnn::conceal {

using Parameters = std::map<std::string, double>;

/// Direction of a force in the sensor frame, and the speed along it [m/s].
struct Guide {
  Eigen::MatrixXd n;      ///< (T, 3)
  Eigen::VectorXd v;      ///< (T), angle in rad instead for `angle:axis`
  Eigen::VectorXd speed;  ///< (T), along it also there
};
Guide guide(const Path& path, const std::string& axis);

/// The number that the force of a law that follows the temperature is proportional to.
std::string strength_of(const Hidden& h);

/// Force against the motion: a function of the speed, or of its history (T).
double friction(const Hidden& h, double v);
Eigen::VectorXd lugre(const Hidden& h, const Eigen::VectorXd& v, double step = kStep);
Eigen::VectorXd bouc_wen(const Hidden& h, const Eigen::VectorXd& q);

/// Adds the force on the tool, if the effect is one; `field`: of felt_field(), `carried`: (T, 3)
/// what is carried before any such force.
void add_force(const Path& path, const Hidden& h, const Eigen::MatrixXd& field,
               const Eigen::MatrixXd& carried, Eigen::MatrixXd& F);
/// Adds the torque (T, 3) of a force `added` (T, 3) that the effect made.
void add_moment(const Path& path, const Hidden& h, const Eigen::MatrixXd& added,
                Eigen::MatrixXd& torque);
/// Adds a law of drawn_laws().
void add_drawn_law(const Path& path, const Hidden& h, const Eigen::MatrixXd& field,
                   Eigen::MatrixXd& F);
/// Resonance and what the sensor makes of the force, if the effect is one of these. Of the path its
/// clock alone is used.
void change_reading(const Path& path, const Hidden& h, Eigen::MatrixXd& F);

}  // namespace dcnn::conceal
