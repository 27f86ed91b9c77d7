// Laws of the hidden effects along a high-rate path, written from vocabulary.md.
#pragma once

#include "conceal/world.h"

namespace dcnn::conceal {

using Parameters = std::map<std::string, double>;

/// Direction of a force in the sensor frame, and the speed along it [m/s].
struct Guide {
  Eigen::MatrixXd n;  ///< (T, 3)
  Eigen::VectorXd v;  ///< (T), angle in rad instead for `angle:axis`
};
Guide guide(const Path& path, const std::string& axis);

/// Adds a force on the tool; false where the effect is none.
bool add_force(const Path& path, const Hidden& h, const Eigen::MatrixXd& field, Eigen::MatrixXd& F);
/// Resonance and what the sensor makes of the force; false where the effect is none of these.
bool change_reading(const Path& path, const Hidden& h, Eigen::MatrixXd& F);

}  // namespace dcnn::conceal
