// SPDX-License-Identifier: Apache-2.0
// The usual messages of ROS 2 as its packages define them (common_interfaces, Apache-2.0).
#include <array>
#include <utility>

#include "import/message_schema.h"

namespace dcnn {
namespace {

using Definition = std::pair<const char*, const char*>;

constexpr std::array kDefinitions = {
    Definition{"std_msgs/Header", "time stamp\nstring frame_id"},
    Definition{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z"},
    Definition{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"},
    Definition{"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w"},
    Definition{"geometry_msgs/Pose", "Point position\nQuaternion orientation"},
    Definition{"geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose"},
    Definition{"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance"},
    Definition{"geometry_msgs/PoseWithCovarianceStamped",
               "std_msgs/Header header\nPoseWithCovariance pose"},
    Definition{"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation"},
    Definition{"geometry_msgs/TransformStamped",
               "std_msgs/Header header\nstring child_frame_id\nTransform transform"},
    Definition{"geometry_msgs/Wrench", "Vector3 force\nVector3 torque"},
    Definition{"geometry_msgs/WrenchStamped", "std_msgs/Header header\nWrench wrench"},
    Definition{"geometry_msgs/Twist", "Vector3 linear\nVector3 angular"},
    Definition{"geometry_msgs/TwistStamped", "std_msgs/Header header\nTwist twist"},
    Definition{"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance"},
    Definition{"geometry_msgs/Accel", "Vector3 linear\nVector3 angular"},
    Definition{"geometry_msgs/AccelStamped", "std_msgs/Header header\nAccel accel"},
    Definition{"geometry_msgs/Vector3Stamped", "std_msgs/Header header\nVector3 vector"},
    Definition{"nav_msgs/Odometry",
               "std_msgs/Header header\nstring child_frame_id\n"
               "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist"},
    Definition{"sensor_msgs/Imu",
               "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
               "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
               "float64[9] angular_velocity_covariance\n"
               "geometry_msgs/Vector3 linear_acceleration\n"
               "float64[9] linear_acceleration_covariance"},
    Definition{"sensor_msgs/JointState",
               "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
               "float64[] effort"},
    Definition{"sensor_msgs/Temperature",
               "std_msgs/Header header\nfloat64 temperature\nfloat64 variance"},
    Definition{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms"},
    Definition{"std_msgs/Float32", "float32 data"},
    Definition{"std_msgs/Float64", "float64 data"},
    Definition{"std_msgs/Int32", "int32 data"},
    Definition{"std_msgs/Int64", "int64 data"},
    Definition{"std_msgs/Bool", "bool data"},
    Definition{"std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride"},
    Definition{"std_msgs/MultiArrayLayout", "MultiArrayDimension[] dim\nuint32 data_offset"},
    Definition{"std_msgs/Float32MultiArray", "MultiArrayLayout layout\nfloat32[] data"},
    Definition{"std_msgs/Float64MultiArray", "MultiArrayLayout layout\nfloat64[] data"}};

}  // namespace

std::string_view standard_definition(const std::string& type) {
  for (const auto& [name, text] : kDefinitions) {
    if (type == name) return text;
  }
  return {};
}

}  // namespace dcnn
