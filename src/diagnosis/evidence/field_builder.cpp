// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/field_builder.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"

namespace dcnn::evidence {
namespace {

/// Odd and even functions of a signed quantity at several scales, of unit rms each.
std::vector<Series> shapes(const Series& u) {
  const double scale = rms(u);
  std::vector<Series> list;
  if (scale == 0.0) return list;
  const auto with = [&](const std::function<Vector(const Vector&)>& f) {
    Series s = mapped(u, [&](const Vector& v) { return f(v / scale); });
    const double size = rms(s);
    if (size > 0.0) list.push_back(mapped(s, [&](const Vector& v) { return Vector(v / size); }));
  };
  with([](const Vector& v) -> Vector { return v; });
  with([](const Vector& v) -> Vector { return v * v.abs(); });
  with([](const Vector& v) -> Vector { return v.abs(); });
  with([](const Vector& v) -> Vector { return v.square(); });
  for (const double width : {0.05, 0.2, 0.7}) {
    with([&](const Vector& v) -> Vector { return elementary::tanh(v / width); });
    with([&](const Vector& v) -> Vector { return v / (1.0 + (v / width).square()); });
    with([&](const Vector& v) -> Vector { return 1.0 / (1.0 + (v / width).square()); });
  }
  return list;
}

}  // namespace

const std::map<char, std::string>& rate_words() {
  static const std::map<char, std::string> words{
      {'b', "velocity along base "}, {'s', "velocity along sensor "}, {'w', "rate about sensor "}};
  return words;
}

double rms(const Series& series) {
  double square = 0.0, count = 0.0;
  for (const Vector& v : series) square += v.square().sum(), count += static_cast<double>(v.size());
  return std::sqrt(square / std::max(1.0, count));
}

Series mapped(const Series& series, const std::function<Vector(const Vector&)>& f) {
  Series out;
  for (const Vector& v : series) out.push_back(f(v));
  return out;
}

Series product(const Series& a, const Series& b) {
  Series out;
  for (std::size_t k = 0; k < a.size(); ++k) out.emplace_back(a[k] * b[k]);
  return out;
}

bool FieldBuilder::moves() const {
  const Motion& motion = study().logs.front().motion;
  return motion.v_B.rows() == motion.samples() && !motion.is_static();
}

Series FieldBuilder::rate_of(char frame, int axis) const {
  return of_logs([&](const Motion& m, std::size_t) {
    if (frame == 'w') return Vector(m.w_S.col(axis).array());
    if (frame == 'b') return Vector(m.v_B.col(axis).array());
    Vector v(m.samples());
    for (Index i = 0; i < v.size(); ++i) {
      v(i) = m.R_BS[static_cast<std::size_t>(i)].col(axis).dot(m.v_B.row(i).transpose());
    }
    return v;
  });
}

Series FieldBuilder::force_of(Index channel) const {
  return of_logs([&](const Motion&, std::size_t k) { return prediction_[k].col(channel).array(); });
}

/// `size` along an axis of the sensor's forces, or of the base's.
Eigen::VectorXd FieldBuilder::column(const Series& size, int axis, bool base) const {
  Signals signals;
  for (std::size_t k = 0; k < size.size(); ++k) {
    const Motion& motion = study().logs[k].motion;
    Eigen::MatrixXd s = Eigen::MatrixXd::Zero(motion.samples(), study().channel_count());
    for (Index j = 0; j < s.cols(); ++j) {
      const int channel = study().channels[static_cast<std::size_t>(j)];
      if (!base) {
        if (channel == axis) s.col(j) = size[k].matrix();
        continue;
      }
      if (channel > 2) continue;
      for (Index i = 0; i < s.rows(); ++i) {
        s(i, j) = size[k](i) * motion.R_BS[static_cast<std::size_t>(i)](axis, channel);
      }
    }
    signals.push_back(std::move(s));
  }
  return grid_(signals);
}

void FieldBuilder::add(const std::string& driver, const std::string& kind,
                       const std::vector<Series>& functions, int axis, bool base) {
  if (functions.empty()) return;
  Field field{driver,
              (base       ? "base_"
               : axis < 3 ? "sensor_"
                          : "torque_") +
                  std::string(kLetters[axis % 3]),
              kind, Eigen::MatrixXd(grid_.rows(), static_cast<Index>(functions.size()))};
  for (std::size_t k = 0; k < functions.size(); ++k) {
    field.columns.col(static_cast<Index>(k)) = column(functions[k], axis, base);
  }
  const double square = field.columns.squaredNorm();
  if (!(square > 0.0) || !std::isfinite(square)) return;
  field.columns *= std::sqrt(static_cast<double>(grid_.rows()) / square);
  fields_.push_back(std::move(field));
}

void FieldBuilder::add_all(const std::string& driver, const std::string& kind,
                           const std::vector<Series>& functions, bool base) {
  for (int axis = 0; axis < 3 && base; ++axis) add(driver, kind, functions, axis, true);
  if (base) return;
  for (const int channel : study().channels) add(driver, kind, functions, channel, false);
}

void FieldBuilder::add_shapes(const std::string& driver, const Series& u, bool base) {
  add_all(driver, "state", shapes(u), base);
}

std::vector<Field> fields(const Grid& grid, const Signals& prediction) {
  FieldBuilder builder(grid, prediction);
  add_state_fields(builder);
  add_memory_fields(builder);
  return builder.take();
}

}  // namespace dcnn::evidence
