// SPDX-License-Identifier: Apache-2.0
// Orientations of other kinds as unit quaternions.
#include <cmath>
#include <functional>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "dcnn/data/rotation.h"
#include "import/arm_pose.h"
#include "import/stream_table.h"

namespace dcnn {
namespace {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

constexpr double kNotOrthogonal = 1e-2;  // largest error of R^T R: beyond it is no rotation matrix
constexpr double kNotUnit = 0.1;         // of a quaternion's length

/// Capitals: about moving axes, in this order; small letters: about fixed axes.
Matrix3 rotation_in_order(const Vector3& angles, const std::string& order) {
  Matrix3 R = Matrix3::Identity();
  for (std::size_t k = 0; k < 3; ++k) {
    const bool moving = order[k] >= 'A' && order[k] <= 'Z';
    const int axis = order[k] - (moving ? 'X' : 'x');
    const Matrix3 turn =
        Eigen::AngleAxisd(angles[static_cast<Index>(k)], Vector3::Unit(axis)).toRotationMatrix();
    R = moving ? Matrix3(R * turn) : Matrix3(turn * R);
  }
  return R;
}

void check_order(const std::string& order, const std::string& file) {
  const bool capitals = order.find_first_not_of("XYZ") == std::string::npos;
  const bool small = order.find_first_not_of("xyz") == std::string::npos;
  require(order.size() == 3 && (capitals || small) && order[0] != order[1] && order[1] != order[2],
          Exit::kData, file, ": ", shown(order),
          " is no order of turns; write three of XYZ (moving axes) or xyz (fixed axes)");
}

/// The angles in the order of `order`. Roll, pitch and yaw are about x, y and z by their names.
Vector3 ordered_angles(const StreamTable& table, const std::string& order, Index row) {
  Vector3 angles;
  for (std::size_t k = 0; k < 3; ++k) {
    std::string column = "rot" + std::to_string(k + 1);
    if (!table.has(column)) {
      const char axis = static_cast<char>(order[k] | 0x20);  // small letter
      column = axis == 'x' ? "gamma" : axis == 'y' ? "beta" : "alpha";
    }
    angles[static_cast<Index>(k)] = table.values(row, table.find(column));
  }
  return angles;
}

Vector3 vector_at(const StreamTable& table, const std::vector<std::string>& columns, Index row) {
  Vector3 v;
  for (std::size_t k = 0; k < 3; ++k) {
    v[static_cast<Index>(k)] = table.values(row, table.find(columns[k]));
  }
  return v;
}

/// Where the columns lie in the table, looked up once for all rows.
std::vector<Index> places_of(const StreamTable& table, const std::vector<std::string>& columns) {
  std::vector<Index> places;
  for (const std::string& column : columns) places.push_back(table.find(column));
  return places;
}

/// `at`: of r11 to r33, row by row.
Matrix3 matrix_at(const StreamTable& table, const std::vector<Index>& at, Index row,
                  const std::string& file) {
  Matrix3 R;
  for (std::size_t k = 0; k < 9; ++k) {
    R(static_cast<Index>(k / 3), static_cast<Index>(k % 3)) = table.values(row, at[k]);
  }
  const double error = (R.transpose() * R - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (error < kNotOrthogonal && R.determinant() > 0.0) return R;
  fail(Exit::kData, file, ": ", shown(table.stream), ": row ", row + 1,
       " holds no rotation matrix (error ", error, R.determinant() > 0.0 ? ")" : ", left-handed)");
}

/// `at`: of qw, qx, qy, qz.
Eigen::Quaterniond quaternion_at(const StreamTable& table, const std::vector<Index>& at, Index row,
                                 const std::string& file) {
  Eigen::Quaterniond q(table.values(row, at[0]), table.values(row, at[1]), table.values(row, at[2]),
                       table.values(row, at[3]));
  if (!(std::abs(q.norm() - 1.0) < kNotUnit)) {  // words are made for a message only
    fail(Exit::kData, file, ": ", shown(table.stream), ": row ", row + 1,
         ": the quaternion has length ", q.norm(), "; is it an orientation?");
  }
  q.normalize();
  return q;
}

using OrientationAt = std::function<Eigen::Quaterniond(Index row)>;

/// How a row's orientation is read, and the columns that it takes.
struct OrientationReader {
  OrientationAt at;
  std::vector<std::string> columns;
};

OrientationReader orientation_reader(const Recipe& recipe, const StreamTable& table,
                                     const std::string& file) {
  const OrientationRule& rule = recipe.orientation;
  if (rule.kind == "euler") {
    check_order(rule.order, file);
    return {[&](Index row) {
              return Eigen::Quaterniond(
                  rotation_in_order(ordered_angles(table, rule.order, row), rule.order));
            },
            table.has("rot1") ? std::vector<std::string>{"rot1", "rot2", "rot3"}
                              : std::vector<std::string>{"alpha", "beta", "gamma"}};
  }
  if (rule.kind == "quaternion") {
    const std::vector<std::string> columns = {"qw", "qx", "qy", "qz"};
    return {[&table, &file, at = places_of(table, columns)](Index row) {
              return quaternion_at(table, at, row, file);
            },
            columns};
  }
  if (rule.kind == "rotation-vector") {
    const std::vector<std::string> columns = {"rvx", "rvy", "rvz"};
    return {[&table, columns](Index row) {
              const Vector3 v = vector_at(table, columns, row);
              const double angle = v.norm();
              const Vector3 axis = angle > 0.0 ? Vector3(v / angle) : Vector3::UnitX();
              return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
            },
            columns};
  }
  const std::vector<std::string> columns = {"r11", "r12", "r13", "r21", "r22",
                                            "r23", "r31", "r32", "r33"};
  return {[&table, &file, at = places_of(table, columns)](Index row) {
            return Eigen::Quaterniond(matrix_at(table, at, row, file));
          },
          columns};
}

/// The pose of the tool in the base from that of the base in the tool.
void invert_pose(StreamTable* table, Eigen::MatrixXd* q) {
  const std::vector<std::string> position = {"x", "y", "z"};
  for (Index row = 0; row < q->rows(); ++row) {
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond((*q)(row, 0), (*q)(row, 1), (*q)(row, 2), (*q)(row, 3)).conjugate();
    q->row(row) << turn.w(), turn.x(), turn.y(), turn.z();
    if (!table->has("x")) continue;
    const Vector3 p = -(turn * vector_at(*table, position, row));
    for (std::size_t k = 0; k < 3; ++k) {
      table->values(row, table->find(position[k])) = p[static_cast<Index>(k)];
    }
  }
}

}  // namespace

void convert_orientation(const Recipe& recipe, StreamTable* table, const std::string& file) {
  const OrientationRule& rule = recipe.orientation;
  if (rule.kind == "joints") return pose_from_joints(recipe.arm, table, file);
  const bool ours = rule.kind == "euler" && table->has("alpha") && rule.order == "ZYX";
  const char* first = rule.kind == "euler"             ? (table->has("rot1") ? "rot1" : "alpha")
                      : rule.kind == "quaternion"      ? "qw"
                      : rule.kind == "rotation-vector" ? "rvx"
                                                       : "r11";
  if (ours && !rule.inverse) {
    Eigen::MatrixXd angles(table->values.rows(), 3);
    const char* columns[] = {"alpha", "beta", "gamma"};
    for (Index k = 0; k < 3; ++k) angles.col(k) = table->values.col(table->find(columns[k]));
    unwrap(angles);
    for (Index k = 0; k < 3; ++k) table->values.col(table->find(columns[k])) = angles.col(k);
  }
  if (rule.kind.empty() || !table->has(first) || (ours && !rule.inverse)) return;
  const OrientationReader reader = orientation_reader(recipe, *table, file);
  for (const std::string& column : reader.columns) {
    require(table->has(column), Exit::kData, file, ": ", shown(table->stream), ": ", column,
            " of the orientation is missing");
  }
  Eigen::MatrixXd q(table->values.rows(), 4);
  for (Index row = 0; row < q.rows(); ++row) {
    const Eigen::Quaterniond turn = reader.at(row);
    q.row(row) << turn.w(), turn.x(), turn.y(), turn.z();
  }
  if (rule.kind != "quaternion") table->drop(reader.columns);
  if (rule.inverse) invert_pose(table, &q);
  for (Index row = 1; row < q.rows(); ++row) {
    if (q.row(row).dot(q.row(row - 1)) < 0.0) q.row(row) *= -1.0;
  }
  const std::vector<std::string> names = {"qw", "qx", "qy", "qz"};
  table->add(names);
  for (Index k = 0; k < 4; ++k) table->set(names[static_cast<std::size_t>(k)], q.col(k));
}

}  // namespace dcnn
