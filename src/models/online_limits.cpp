// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/online_limits.h"

#include <algorithm>
#include <cmath>

#include "core/linear_algebra.h"

namespace dcnn {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kFolds = 5;

std::vector<double> numbers(const VectorXd& v) { return {v.data(), v.data() + v.size()}; }

VectorXd vector_of(const Json& json) {
  const auto values = json.get<std::vector<double>>();
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

/// Largest score of each second.
std::vector<double> second_maxima(const VectorXd& scores, double per_second) {
  const auto rows = std::max<Index>(1, std::llround(per_second));
  std::vector<double> maxima;
  for (Index begin = 0; begin < scores.size(); begin += rows) {
    maxima.push_back(scores.segment(begin, std::min(rows, scores.size() - begin)).maxCoeff());
  }
  return maxima;
}

}  // namespace

double alarm_level(const VectorXd& scores, double per_second, double per_hour) {
  std::vector<double> maxima = second_maxima(scores, per_second);
  std::sort(maxima.begin(), maxima.end());
  const double chance = per_hour / 3600.0, count = static_cast<double>(maxima.size());
  const double rank = std::ceil((count + 1.0) * (1.0 - chance));
  if (rank <= count) return maxima[static_cast<std::size_t>(rank) - 1];
  const std::size_t half = maxima.size() / 2;
  const double threshold = maxima[half];
  double excess = 0.0;
  for (std::size_t i = half; i < maxima.size(); ++i) excess += maxima[i] - threshold;
  const double above = static_cast<double>(maxima.size() - half);
  const double mean = excess / above * (1.0 + 2.0 / std::sqrt(above));
  return threshold + mean * std::log(0.5 / chance);
}

void Envelope::learn(const MatrixXd& x) {
  const double n = static_cast<double>(x.rows());
  mean_ = x.colwise().mean().transpose();
  MatrixXd z = x.rowwise() - mean_.transpose();
  scale_ = (z.colwise().squaredNorm() / n).cwiseSqrt().transpose().cwiseMax(1e-9);
  z = z * scale_.cwiseInverse().asDiagonal();
  MatrixXd correlation = z.transpose() * z / n;
  correlation.diagonal().array() +=
      1e-4;  // two features that always move together may part a little
  whitener_ = inverse_cholesky(correlation);
}

Envelope::Envelope(const MatrixXd& x, double dt) {
  const Index rows = x.rows();
  VectorXd distances(rows), channels(rows);
  for (Index fold = 0; fold < kFolds; ++fold) {
    const Index begin = rows * fold / kFolds, end = rows * (fold + 1) / kFolds;
    MatrixXd others(rows - (end - begin), x.cols());
    others << x.topRows(begin), x.bottomRows(rows - end);
    learn(others.rows() > 0 ? others : x);
    for (Index k = begin; k < end; ++k) {
      const Parts part = parts(&x(k, 0), x.outerStride());
      distances[k] = part.distance;
      channels[k] = part.channel;
    }
  }
  learn(x);
  distance_limit_ = alarm_level(distances, 1.0 / dt, kFalseAlarmsPerHour / 2.0);
  channel_limit_ = alarm_level(channels, 1.0 / dt, kFalseAlarmsPerHour / 2.0);
}

Envelope::Parts Envelope::parts(const double* x, Index stride) const noexcept {
  double squares = 0.0, most = 0.0;
  for (Index i = 0; i < mean_.size(); ++i) {
    double whitened = 0.0;
    for (Index j = 0; j <= i; ++j) {
      whitened += whitener_(i, j) * ((x[j * stride] - mean_[j]) / scale_[j]);
    }
    squares += whitened * whitened;
    most = std::max(most, std::abs(x[i * stride] - mean_[i]) / scale_[i]);
  }
  return {std::sqrt(squares), most};
}

double Envelope::score(const VectorXd& x) const noexcept {
  const Parts part = parts(x.data(), 1);
  if (!std::isfinite(part.distance)) return part.distance;
  return std::max(part.distance / distance_limit_, part.channel / channel_limit_);
}

Json Envelope::to_json() const {
  Json rows = Json::array();
  for (Index i = 0; i < features(); ++i) {
    rows.push_back(numbers(whitener_.row(i).head(i + 1).transpose()));
  }
  return {{"mean", numbers(mean_)},
          {"scale", numbers(scale_)},
          {"whitener", rows},
          {"distance_limit", distance_limit_},
          {"channel_limit", channel_limit_}};
}

Envelope Envelope::parse(const Json& json, const std::string& where) {
  try {
    Envelope envelope;
    envelope.mean_ = vector_of(json.at("mean"));
    envelope.scale_ = vector_of(json.at("scale"));
    envelope.distance_limit_ = json.at("distance_limit").get<double>();
    envelope.channel_limit_ = json.at("channel_limit").get<double>();
    const Index count = envelope.features();
    const Json& rows = json.at("whitener");
    bool sound = count > 0 && envelope.scale_.size() == count &&
                 static_cast<Index>(rows.size()) == count && envelope.scale_.minCoeff() > 0.0 &&
                 envelope.distance_limit_ > 0.0 && envelope.channel_limit_ > 0.0;
    envelope.whitener_ = MatrixXd::Zero(sound ? count : 0, sound ? count : 0);
    for (Index i = 0; sound && i < count; ++i) {
      const VectorXd row = vector_of(rows.at(static_cast<std::size_t>(i)));
      sound = row.size() == i + 1;
      if (sound) envelope.whitener_.row(i).head(i + 1) = row.transpose();
    }
    require(sound, Exit::kModel, where, ": its envelope of training is malformed; train again");
    return envelope;
  } catch (const Json::exception&) {
    fail(Exit::kModel, where, ": its envelope of training is malformed; train again");
  }
}

Index contact_window(double dt) { return std::clamp<Index>(std::llround(0.05 / dt), 1, 128); }

double contact_level(const MatrixXd& residual, const std::vector<Segment>& segments, double dt) {
  const Index window = contact_window(dt);
  VectorXd size = VectorXd::Zero(residual.rows());
  for (const Segment& segment : segments) {
    for (Index k = segment.begin + window - 1; k < segment.end; ++k) {
      size[k] = residual.middleRows(k - window + 1, window).colwise().mean().norm();
    }
  }
  return alarm_level(size, 1.0 / dt, kFalseAlarmsPerHour);
}

OnlineLimits learn_limits(const Model& model, const Targets& targets, const Samples& training,
                          const Samples& validation, double dt) {
  constexpr double kEnough = 5.0;  // s
  OnlineLimits limits;
  limits.envelope = Envelope(training.x, dt);
  const bool held_out = static_cast<double>(validation.rows()) * dt >= kEnough;
  const Samples& judge = held_out ? validation : training;
  const MatrixXd residual = judge.y - model.predict(judge);
  limits.residual_rmse = residual.array().square().colwise().mean().sqrt().transpose();
  MatrixXd force = MatrixXd::Zero(residual.rows(), 3);
  for (std::size_t j = 0; j < targets.names.size(); ++j) {
    const std::string& name = targets.names[j];
    if (name.size() == 2 && name[0] == 'f') {
      force.col(name[1] - 'x') = residual.col(static_cast<Index>(j));
    }
  }
  limits.contact_n = contact_level(force, judge.segments, dt);
  return limits;
}

Json to_json(const OnlineLimits& limits) {
  return {{"envelope", limits.envelope.to_json()},
          {"residual_rmse", numbers(limits.residual_rmse)},
          {"contact_n", limits.contact_n}};
}

OnlineLimits parse_limits(const Json& json, const std::string& where) {
  try {
    OnlineLimits limits;
    limits.envelope = Envelope::parse(json.at("envelope"), where);
    limits.residual_rmse = vector_of(json.at("residual_rmse"));
    limits.contact_n = json.at("contact_n").get<double>();
    require(std::isfinite(limits.contact_n) && limits.contact_n >= 0.0, Exit::kModel, where,
            ": its contact threshold is malformed; train again");
    return limits;
  } catch (const Json::exception&) {
    fail(Exit::kModel, where, ": its limits for online use are malformed; train again");
  }
}

}  // namespace dcnn
