// SPDX-License-Identifier: Apache-2.0
// Named coordinates and directions, and their values at one sample.
#include <cmath>

#include "dcnn/physics/law.h"

namespace dcnn::law {
namespace {

// Blocks of coordinates() and directions(), in the order of the lists below.
enum CoordinateBlock : std::size_t {
  kVelocityBase = 0,
  kVelocitySensor = 3,
  kRateBase = 6,
  kRateSensor = 9,
  kAccelerationBase = 12,
  kAccelerationSensor = 15,
  kAngularAcceleration = 18,
  kPosition = 21,
  kAngle = 24,
  kLoadBase = 27,
  kLoadSensor = 30,
  kSpeed = 33,
  kRate,
  kSpeedSquared,
  kLoad,
  kLoadAcross,
  kClock,
  kSignal,
  kVelocityAlong = kSignal + kMostSignals,
  kRateAlong,
  kPositionAlong,
  kLoadAlong,
  kDistance,
};
enum DirectionBlock : std::size_t {
  kSensorAxis = 0,
  kBaseAxis = 3,
  kAlongVelocity = 6,
  kVelocityVector,
  kRateVector,
  kAccelerationVector,
  kAngularAccelerationVector,
  kLoadVector,
  kVelocityCross = 12,
  kRateCross = 15,
  kFromPoint = 18,
};

Vector3d unit(const Vector3d& x) {
  const double norm = x.norm();
  return norm > 0.0 ? Vector3d(x / norm) : Vector3d(Vector3d::Zero());
}

}  // namespace

const std::vector<Coordinate>& coordinates() {
  static const std::vector<Coordinate> list{
      {"v_base_x", "m/s", "base", "the velocity along the base's x axis", true},
      {"v_base_y", "m/s", "base", "the velocity along the base's y axis", true},
      {"v_base_z", "m/s", "base", "the velocity along the base's z axis", true},
      {"v_sensor_x", "m/s", "sensor", "the velocity along the sensor's x axis", true},
      {"v_sensor_y", "m/s", "sensor", "the velocity along the sensor's y axis", true},
      {"v_tool_z", "m/s", "tool", "the velocity along the tool", true},
      {"w_base_x", "rad/s", "base", "the angular velocity about the base's x axis", true},
      {"w_base_y", "rad/s", "base", "the angular velocity about the base's y axis", true},
      {"w_base_z", "rad/s", "base", "the angular velocity about the base's z axis", true},
      {"w_sensor_x", "rad/s", "sensor", "the angular velocity about the sensor's x axis", true},
      {"w_sensor_y", "rad/s", "sensor", "the angular velocity about the sensor's y axis", true},
      {"w_tool_z", "rad/s", "tool", "the angular velocity about the tool", true},
      {"a_base_x", "m/s^2", "base", "the acceleration along the base's x axis"},
      {"a_base_y", "m/s^2", "base", "the acceleration along the base's y axis"},
      {"a_base_z", "m/s^2", "base", "the acceleration along the base's z axis"},
      {"a_sensor_x", "m/s^2", "sensor", "the acceleration along the sensor's x axis"},
      {"a_sensor_y", "m/s^2", "sensor", "the acceleration along the sensor's y axis"},
      {"a_tool_z", "m/s^2", "tool", "the acceleration along the tool"},
      {"dw_sensor_x", "rad/s^2", "sensor", "the angular acceleration about the sensor's x axis"},
      {"dw_sensor_y", "rad/s^2", "sensor", "the angular acceleration about the sensor's y axis"},
      {"dw_tool_z", "rad/s^2", "tool", "the angular acceleration about the tool"},
      {"x", "m", "base", "the position x"},
      {"y", "m", "base", "the position y"},
      {"z", "m", "base", "the position z"},
      {"alpha", "rad", "base", "the angle alpha"},
      {"beta", "rad", "base", "the angle beta"},
      {"gamma", "rad", "base", "the angle gamma"},
      {"f_base_x", "N", "base", "the predicted force along the base's x axis"},
      {"f_base_y", "N", "base", "the predicted force along the base's y axis"},
      {"f_base_z", "N", "base", "the predicted force along the base's z axis"},
      {"f_sensor_x", "N", "sensor", "the predicted force along the sensor's x axis"},
      {"f_sensor_y", "N", "sensor", "the predicted force along the sensor's y axis"},
      {"f_tool_z", "N", "tool", "the predicted force along the tool"},
      {"speed", "m/s", "", "the speed", true},
      {"rate", "rad/s", "", "the rate of turning", true},
      {"speed_squared", "m^2/s^2", "", "the square of the speed"},
      {"load", "N", "", "the size of the predicted force"},
      {"load_across", "N", "tool", "the size of the predicted force across the tool"},
      {"t", "s", "", "the time", false, true},
      {"signal_1", "", "", "a logged signal"},
      {"signal_2", "", "", "a logged signal"},
      {"signal_3", "", "", "a logged signal"},
      {"v_along", "m/s", "axis", "the velocity along it", true},
      {"w_along", "rad/s", "axis", "the angular velocity about it", true},
      {"p_along", "m", "axis", "the position along it"},
      {"f_along", "N", "axis", "the predicted force along it"},
      {"distance", "m", "", "the distance from it"}};
  return list;
}

const std::vector<Direction>& directions() {
  static const std::vector<Direction> list{
      {"sensor_x", "", "the sensor's x axis"},
      {"sensor_y", "", "the sensor's y axis"},
      {"tool_z", "", "the tool"},
      {"base_x", "", "the base's x axis"},
      {"base_y", "", "the base's y axis"},
      {"base_z", "", "the base's z axis"},
      {"along_velocity", "", "the direction of motion"},
      {"velocity", "m/s", "the velocity vector"},
      {"angular_velocity", "rad/s", "the angular velocity vector"},
      {"acceleration", "m/s^2", "the acceleration vector"},
      {"angular_acceleration", "rad/s^2", "the angular acceleration vector"},
      {"load", "N", "the predicted force"},
      {"velocity_cross_base_x", "m/s", "the vector product of velocity and the base's x axis"},
      {"velocity_cross_base_y", "m/s", "the vector product of velocity and the base's y axis"},
      {"velocity_cross_base_z", "m/s", "the vector product of velocity and the base's z axis"},
      {"rate_cross_sensor_x", "rad/s",
       "the vector product of angular velocity and the sensor's x axis"},
      {"rate_cross_sensor_y", "rad/s",
       "the vector product of angular velocity and the sensor's y axis"},
      {"rate_cross_tool_z", "rad/s", "the vector product of angular velocity and the tool's axis"},
      {"from_point", "", "the line from a point"}};
  return list;
}

std::size_t drive_direction() { return kBaseAxis; }

bool is_own(std::size_t coordinate) { return coordinate >= kVelocityAlong; }
bool is_signal(std::size_t coordinate) {
  return coordinate >= kSignal && coordinate < kSignal + kMostSignals;
}
std::size_t signal_coordinate(std::size_t signal) { return kSignal + signal; }
bool is_axis(std::size_t direction) { return direction < kAlongVelocity; }
bool has_axis(std::size_t direction) {
  return is_axis(direction) || (direction >= kVelocityCross && direction < kFromPoint);
}
bool is_central(std::size_t direction) { return direction == kFromPoint; }

int own_numbers(const Structure& structure) {
  return is_central(structure.direction) ? 3 : structure.oblique ? 2 : 0;
}

Vector3d own_vector(const Structure& structure, const double* numbers) {
  if (is_central(structure.direction)) return {numbers[0], numbers[1], numbers[2]};
  if (!has_axis(structure.direction)) return Vector3d::Zero();
  const auto k = static_cast<Eigen::Index>(structure.direction % 3);
  Vector3d axis = Vector3d::Unit(k);
  if (!structure.oblique) return axis;
  axis[(k + 1) % 3] = numbers[0];
  axis[(k + 2) % 3] = numbers[1];
  return axis.normalized();
}

double coordinate_at(std::size_t coordinate, const Sample& now) {
  if (is_signal(coordinate)) return now.signals[coordinate - kSignal];
  const auto i = static_cast<Eigen::Index>(coordinate % 3);
  switch (coordinate / 3 * 3) {
    case kVelocityBase:
      return now.v_B[i];
    case kVelocitySensor:
      return now.R_BS.col(i).dot(now.v_B);
    case kRateBase:
      return now.R_BS.row(i).dot(now.w_S);
    case kRateSensor:
      return now.w_S[i];
    case kAccelerationBase:
      return now.a_B[i];
    case kAccelerationSensor:
      return now.R_BS.col(i).dot(now.a_B);
    case kAngularAcceleration:
      return now.dw_S[i];
    case kPosition:
      return now.p_B[i];
    case kAngle:
      return now.euler[i];
    case kLoadBase:
      return now.R_BS.row(i).dot(now.load_S);
    case kLoadSensor:
      return now.load_S[i];
    default:
      break;
  }
  switch (coordinate) {
    case kSpeed:
      return now.v_B.norm();
    case kRate:
      return now.w_S.norm();
    case kSpeedSquared:
      return now.v_B.squaredNorm();
    case kLoad:
      return now.load_S.norm();
    case kLoadAcross:
      return std::sqrt(now.load_S[0] * now.load_S[0] + now.load_S[1] * now.load_S[1]);
    default:
      return now.t;
  }
}

double coordinate_at(std::size_t coordinate, const Sample& now, const Vector3d& n_S,
                     const Vector3d& own) {
  switch (coordinate) {
    case kVelocityAlong:
      return (now.R_BS * n_S).dot(now.v_B);
    case kRateAlong:
      return n_S.dot(now.w_S);
    case kPositionAlong:
      return (now.R_BS * n_S).dot(now.p_B);
    case kLoadAlong:
      return n_S.dot(now.load_S);
    case kDistance:
      return (now.p_B - own).norm();
    default:
      return coordinate_at(coordinate, now);
  }
}

Vector3d direction_at(std::size_t direction, const Sample& now, const Vector3d& own) {
  if (direction < kBaseAxis) return own;
  if (direction < kAlongVelocity) return now.R_BS.transpose() * own;
  if (is_central(direction)) return now.R_BS.transpose() * unit(now.p_B - own);
  if (direction >= kRateCross) return now.w_S.cross(own);
  if (direction >= kVelocityCross) return now.R_BS.transpose() * now.v_B.cross(own);
  switch (direction) {
    case kAlongVelocity:
      return now.R_BS.transpose() * unit(now.v_B);
    case kVelocityVector:
      return now.R_BS.transpose() * now.v_B;
    case kRateVector:
      return now.w_S;
    case kAccelerationVector:
      return now.R_BS.transpose() * now.a_B;
    case kAngularAccelerationVector:
      return now.dw_S;
    default:
      return now.load_S;
  }
}

bool needs_clock(const Structure& structure) {
  for (const Factor& factor : structure.factors) {
    if (coordinates()[factor.coordinate].is_clock) return true;
  }
  return false;
}

bool needs_position(const Structure& structure) {
  if (is_central(structure.direction)) return true;
  for (const Factor& factor : structure.factors) {
    const std::size_t c = factor.coordinate;
    if ((c >= kPosition && c < kAngle) || c == kPositionAlong || c == kDistance) return true;
  }
  return false;
}

}  // namespace dcnn::law
