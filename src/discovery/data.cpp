// SPDX-License-Identifier: Apache-2.0
#include "discovery/data.h"

#include <algorithm>
#include <cmath>

namespace dcnn::discovery {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Data::Data(const Problem& problem) : problem_(problem) {
  for (const Record& record : problem.records) {
    begins_.push_back(samples_);
    samples_ += record.motion->samples();
    dt_ = record.motion->dt;
    of_axis_ = record.motion->of_axis;
  }
  begins_.push_back(samples_);
  if (!problem.records.empty()) {
    for (const LoggedSignal& logged : problem.records.front().motion->signals) {
      if (signals_.size() < law::kMostSignals) signals_.push_back(logged.name);
    }
  }
  seconds_ = dt_ * static_cast<double>(samples_);
  step_ = VectorXd::Constant(samples_, dt_);
  values_.assign(law::coordinates().size(), VectorXd(samples_));
  directions_.assign(law::directions().size(), MatrixXd::Zero(samples_, 3));
  for (std::size_t k = 0; k < problem.records.size(); ++k) read(problem.records[k], begins_[k]);
  measure();
}

void Data::read(const Record& record, Index begin) {
  const Motion& motion = *record.motion;
  std::vector<bool> there(values_.size());
  for (std::size_t c = 0; c < there.size(); ++c) there[c] = !of_axis_ || law::is_of_axes(c);
  for (Index k = 0; k < motion.samples(); ++k) {
    const law::Sample now = law::sample_of(motion, k, record.load.row(k), signals_);
    for (std::size_t c = 0; c < values_.size(); ++c) {
      if (law::is_own(c)) break;  // the last ones
      values_[c](begin + k) = there[c] ? law::coordinate_at(c, now) : 0.0;
    }
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      law::Vector3d own = law::Vector3d::Zero();
      if (law::has_axis(d)) own = law::Vector3d::Unit(static_cast<Index>(d % 3));
      if (of_axis_ && d != law::drive_direction()) continue;
      directions_[d].row(begin + k) = law::direction_at(d, now, own).transpose();
    }
    now_.push_back(now);
    if (k > 0) step_(begin + k) = motion.t(k) - motion.t(k - 1);
  }
}

void Data::measure() {
  const auto count = static_cast<double>(samples_);
  for (std::size_t c = 0; c < values_.size(); ++c) {
    if (law::is_own(c)) break;  // the last ones
    low_.push_back(values_[c].minCoeff());
    high_.push_back(values_[c].maxCoeff());
    rms_.push_back(std::sqrt(values_[c].squaredNorm() / count));
    if (!law::coordinates()[c].is_rate) {
      path_range_.push_back(high_.back() - low_.back());
      continue;
    }
    double x = 0.0, least = 0.0, most = 0.0;
    for (Index k = 0; k < samples_; ++k) {
      x += values_[c](k) * step_(k);
      least = std::min(least, x), most = std::max(most, x);
    }
    path_range_.push_back(most - least);
  }
  for (const MatrixXd& direction : directions_) {
    const double size = std::sqrt(direction.squaredNorm() / count);
    sizes_.push_back(size > 1e-9 ? size : 0.0);
  }
  measure_own();
}

void Data::measure_own() {
  const auto add = [&](double low, double high, double rms, double path) {
    low_.push_back(low), high_.push_back(high), rms_.push_back(rms), path_range_.push_back(path);
  };
  const auto widest = [&](const std::vector<double>& list, const char* first) {
    const auto at = list.begin() + static_cast<std::ptrdiff_t>(coordinate_named(first));
    return *std::max_element(at, at + 3);
  };
  const double third = std::sqrt(1.0 / 3.0);
  const std::size_t x = coordinate_named("x");
  double diagonal = 0.0, farthest = 0.0;
  for (std::size_t c = x; c < x + 3; ++c) {
    diagonal = std::hypot(diagonal, high(c) - low(c));
    farthest = std::hypot(farthest, std::max(std::abs(low(c)), std::abs(high(c))));
  }
  // In the order of the list of coordinates: velocity, rate, position, force, distance.
  const double speed = high(coordinate_named("speed")), rate = high(coordinate_named("rate")),
               load = high(coordinate_named("load"));
  add(-speed, speed, third * rms(coordinate_named("speed")), widest(path_range_, "v_base_x"));
  add(-rate, rate, third * rms(coordinate_named("rate")), widest(path_range_, "w_base_x"));
  add(-farthest, farthest, third * diagonal, widest(path_range_, "x"));
  add(-load, load, third * rms(coordinate_named("load")), 2.0 * load);
  add(0.0, 2.0 * diagonal, 0.5 * diagonal, diagonal);
}

MatrixXd Data::direction(const Sketch& sketch) const {
  if (own_numbers(sketch) == 0) return directions_[sketch.direction];
  const law::Vector3d own = own_vector(sketch);
  MatrixXd rows(samples_, 3);
  for (Index k = 0; k < samples_; ++k) {
    const law::Sample& now = now_[static_cast<std::size_t>(k)];
    rows.row(k) = law::direction_at(sketch.direction, now, own).transpose();
  }
  return rows;
}

VectorXd Data::own_coordinate(std::size_t coordinate, const Sketch& of) const {
  const law::Vector3d own = own_vector(of);
  VectorXd values(samples_);
  for (Index k = 0; k < samples_; ++k) {
    const law::Sample& now = now_[static_cast<std::size_t>(k)];
    values(k) = law::coordinate_at(coordinate, now, law::direction_at(of.direction, now, own), own);
  }
  return values;
}

VectorXd Data::product(const std::vector<Piece>& pieces, const Sketch& of) const {
  VectorXd product = VectorXd::Ones(samples_);
  for (const Piece& piece : pieces) {
    law::FactorRun run(piece.factor, numbers_of(piece).data());
    const std::size_t c = piece.factor.coordinate;
    const VectorXd q = law::is_own(c) ? own_coordinate(c, of) : values_[c];
    for (std::size_t r = 0; r + 1 < begins_.size(); ++r) {
      for (Index k = begins_[r]; k < begins_[r + 1]; ++k) {
        product(k) *= run.step(q(k), step_(k), k == begins_[r]);
      }
    }
  }
  return product;
}

VectorXd Data::lagged(const VectorXd& signal, double tau, double spread) const {
  VectorXd out(samples_);
  law::LagRun<double> lag;
  law::LagsRun lags(spread > 0.0 ? tau : 0.0, spread);
  for (std::size_t r = 0; r + 1 < begins_.size(); ++r) {
    for (Index k = begins_[r]; k < begins_[r + 1]; ++k) {
      const bool first = k == begins_[r];
      out(k) = spread > 0.0 ? lags.step(signal(k), step_(k), first)
                            : lag.step(signal(k), tau, step_(k), first);
    }
  }
  return out;
}

MatrixXd Data::presliding(double length) const {
  MatrixXd out(samples_, 3);
  law::PreslidingRun run;
  for (std::size_t r = 0; r + 1 < begins_.size(); ++r) {
    for (Index k = begins_[r]; k < begins_[r + 1]; ++k) {
      const law::Sample& now = now_[static_cast<std::size_t>(k)];
      out.row(k) = run.step(now, length, step_(k), k == begins_[r]).transpose();
    }
  }
  return out;
}

MatrixXd Data::vector_of(const Sketch& sketch) const {
  if (sketch.vector_length > 0.0) return presliding(sketch.vector_length);
  const MatrixXd direction = this->direction(sketch);
  const double scale = *law::directions()[sketch.direction].unit ? sketch.vector_scale : 1.0;
  if (sketch.vector_lag <= 0.0) return direction / scale;
  MatrixXd out(samples_, 3);
  for (Index i = 0; i < 3; ++i) out.col(i) = lagged(direction.col(i) / scale, sketch.vector_lag);
  return out;
}

VectorXd Data::whiten(const MatrixXd& force) const {
  std::vector<MatrixXd> forces;
  for (std::size_t r = 0; r + 1 < begins_.size(); ++r) {
    forces.push_back(force.middleRows(begins_[r], begins_[r + 1] - begins_[r]));
  }
  return problem_.whiten(forces);
}

MatrixXd Data::transposed(const VectorXd& rows) const {
  const auto parts = problem_.transposed(rows);
  MatrixXd out(samples_, 3);
  for (std::size_t r = 0; r + 1 < begins_.size(); ++r) {
    out.middleRows(begins_[r], begins_[r + 1] - begins_[r]) = parts[r];
  }
  return out;
}

VectorXd Data::raw_column(const Sketch& sketch) const {
  return raw_column(product(sketch.pieces, sketch), vector_of(sketch), sketch);
}

VectorXd Data::raw_column(VectorXd product, const MatrixXd& vector, const Sketch& sketch) const {
  if (sketch.lag > 0.0) product = lagged(product, sketch.lag, sketch.spread);
  return whiten(product.asDiagonal() * vector);
}

MatrixXd Data::projected(const MatrixXd& columns) const {
  if (problem_.known.cols() == 0) return columns;
  const MatrixXd shares = problem_.known.transpose() * columns;
  MatrixXd beside = columns;
  beside.noalias() -= problem_.known * shares;
  return beside;
}

VectorXd Data::column(const Sketch& sketch) const { return projected(raw_column(sketch)); }

}  // namespace dcnn::discovery
