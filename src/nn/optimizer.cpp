// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/optimizer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nn/kernels/elementwise.h"

namespace dcnn {
namespace {

using Role = NamedTensor::Role;

std::vector<NamedTensor> trained_only(std::vector<NamedTensor> tensors) {
  std::erase_if(tensors, [](const NamedTensor& t) { return t.role == Role::kStatistic; });
  return tensors;
}

/// Four sums hide the latency of addition; double, as squares of large gradients overflow float.
double norm(std::span<const Real> values) {
  double sums[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= values.size(); i += 4) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto value = static_cast<double>(values[i + k]);
      sums[k] += value * value;
    }
  }
  for (; i < values.size(); ++i) {
    sums[0] += static_cast<double>(values[i]) * static_cast<double>(values[i]);
  }
  return std::sqrt((sums[0] + sums[1]) + (sums[2] + sums[3]));
}

/// What makes a gradient no longer than `most` (0: any length); its direction stays.
double clip_factor(const Tensor& parameter, double most) {
  if (most == 0) return 1;
  const double length = norm(parameter.gradient());
  return length > most ? most / length : 1;
}

/// At step t.
AdamStep coefficients_of(const NamedTensor& parameter, const Adam::Settings& settings, double rate,
                         double t) {
  const double correction1 = 1 - std::pow(settings.beta1, t);
  const double correction2 = 1 - std::pow(settings.beta2, t);
  return {.beta1 = static_cast<Real>(settings.beta1),
          .beta2 = static_cast<Real>(settings.beta2),
          .rate = static_cast<Real>(rate / correction1),
          .root_scale = static_cast<Real>(1 / std::sqrt(correction2)),
          .epsilon = static_cast<Real>(settings.epsilon),
          .l2 = static_cast<Real>(parameter.role == Role::kWeight ? settings.l2 : 0.0),
          .gradient_scale = static_cast<Real>(clip_factor(parameter.tensor, settings.clip))};
}

}  // namespace

Adam::Adam(std::vector<NamedTensor> parameters, Settings settings)
    : parameters_(trained_only(std::move(parameters))), settings_(settings) {
  for (const auto& parameter : parameters_) {
    first_.emplace_back(parameter.tensor.shape());
    second_.emplace_back(parameter.tensor.shape());
  }
}

void Adam::step(double rate) {
  ++steps_;
  std::vector<AdamStep> coefficients;
  std::vector<Real*> gradients;  // asked for once: the first call makes zeros, where nothing was
  for (const NamedTensor& parameter : parameters_) {
    gradients.push_back(parameter.tensor.gradient_data());
    coefficients.push_back(
        coefficients_of(parameter, settings_, rate, static_cast<double>(steps_)));
  }
  Index total = 0;
  for (const NamedTensor& parameter : parameters_) total += parameter.tensor.size();
  constexpr Index kPieces = 4;  // of all parameters one behind the other
  for_each_piece(kPieces, [&](Index k) {
    const Index begin = piece_begin(total, kPieces, k), end = piece_begin(total, kPieces, k + 1);
    Index start = 0;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      const Tensor& parameter = parameters_[i].tensor;
      const Index first = std::max<Index>(begin - start, 0);
      const Index count = std::min(end - start, parameter.size()) - first;
      if (count > 0) {
        adam(coefficients[i], count, gradients[i] + first, first_[i].data() + first,
             second_[i].data() + first, parameter.data() + first);
      }
      start += parameter.size();
    }
  });
  for (const NamedTensor& parameter : parameters_) parameter.tensor.clear_gradient();
}

std::vector<NamedTensor> Adam::state() const {
  std::vector<NamedTensor> state;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    state.push_back({parameters_[i].name + ".m", first_[i], Role::kStatistic});
    state.push_back({parameters_[i].name + ".v", second_[i], Role::kStatistic});
  }
  return state;
}

LearningRate::LearningRate(Options& training, Index epochs, Index steps_per_epoch)
    : initial_(training.number("lr", 1e-3, 0.0, 1e3)),
      factor_(training.number("drop_factor", 0.1, 0.0, 1.0)),
      period_(training.get<Index>("drop_period", std::max<Index>(epochs, 1))),
      total_steps_(std::max<Index>(epochs * steps_per_epoch, 1)),
      steps_per_epoch_(steps_per_epoch) {
  const auto word = training.choice("schedule", "piecewise", {"constant", "piecewise", "cosine"});
  kind_ = word == "constant" ? Kind::kConstant
          : word == "cosine" ? Kind::kCosine
                             : Kind::kPiecewise;
  if (period_ < 1) training.reject("drop_period", "must be at least 1, not ", period_);
}

double LearningRate::at(Index epoch, Index step) const {
  switch (kind_) {
    case Kind::kConstant:
      return initial_;
    case Kind::kPiecewise:
      return initial_ * std::pow(factor_, static_cast<double>(epoch / period_));
    case Kind::kCosine:
      break;
  }
  const double done = static_cast<double>(epoch * steps_per_epoch_ + step);
  return initial_ * 0.5 *
         (1 + std::cos(std::numbers::pi * done / static_cast<double>(total_steps_)));
}

WeightAverage::WeightAverage(std::vector<NamedTensor> parameters, double decay)
    : parameters_(trained_only(std::move(parameters))), decay_(decay) {
  for (const auto& parameter : parameters_) {
    averages_.push_back(Tensor::from(parameter.tensor.shape(), parameter.tensor.values()));
  }
}

void WeightAverage::update() {
  const Real weight = static_cast<Real>(1 - decay_);
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const Real* value = parameters_[i].tensor.data();
    for (Real& average : averages_[i].values()) average += weight * (*value++ - average);
  }
}

void WeightAverage::swap() {
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const auto values = parameters_[i].tensor.values();
    std::swap_ranges(values.begin(), values.end(), averages_[i].values().begin());
  }
}

std::vector<NamedTensor> WeightAverage::state() const {
  std::vector<NamedTensor> state;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    state.push_back({parameters_[i].name + ".ema", averages_[i], Role::kStatistic});
  }
  return state;
}

}  // namespace dcnn
