// SPDX-License-Identifier: Apache-2.0
#include "models/frame_tcn/net.h"

#include <cmath>

namespace dcnn::frame_tcn {
namespace {

using Units = Eigen::Matrix<double, 9, 1>;
using Eigen::Vector3d;

void fill_normal(Eigen::Ref<Eigen::VectorXd> values, double deviation, Rng& rng) {
  for (double& value : values) value = deviation * rng.normal();
}

/// Instant in SI of denoised channels.
Instant instant_of(const Net& net, const Eigen::Ref<const Eigen::VectorXd>& clean) {
  return net.mean + net.scale.cwiseProduct(clean);
}

/// v, R^T v and omega, which the saturating units act on.
Units units_of(const Instant& x, const Frame& frame) {
  Units u;
  u << x.segment<3>(3), frame.velocity, frame.omega;
  return u;
}

}  // namespace

Net::Net(const Plan& plan, Rng& rng)
    : unit(Eigen::VectorXd::Ones(kSmooth)),
      plan_(plan),
      gate_{kChannels, 24, kChannels * plan.experts},
      gain_{kChannels, 16, kSaturating} {
  parameters = Eigen::VectorXd::Zero(head_begin() + plan.triples * 6 * columns_z());
  if (plan.dense) {
    Dense::start(parameters.head(Dense::size()), rng);
  } else if (gate_size() > 0) {
    fill_normal(parameters.head(24 * kChannels), 1.0 / std::sqrt(15.0), rng);
    fill_normal(parameters.segment(24 * (kChannels + 1), gate_.outputs * 24), 0.05, rng);
  }
  if (plan.saturation) {
    fill_normal(parameters.segment(gain_begin(), 16 * kChannels), 1.0 / std::sqrt(15.0), rng);
  }
  mean = level_mean = level_noisy = Eigen::VectorXd::Zero(kChannels);
  scale = level_scale = Eigen::VectorXd::Ones(kChannels);
}

void Net::start_scales(const Eigen::VectorXd& rms) {
  if (!plan_.saturation) return;
  for (Index i = 0; i < kSaturating; ++i) {
    const double place = static_cast<double>(i % kScales) / (kScales - 1);
    const double share = 0.004 * std::pow(0.3 / 0.004, place);
    parameters[scale_begin() + i] = std::log(share * std::max(rms[i / kScales], 1e-9));
  }
}

Index Net::world_begin(Index triple) const { return head_begin() + triple * 6 * columns_z(); }

Eigen::Map<const Eigen::MatrixXd> Net::world(Index triple) const {
  return {parameters.data() + world_begin(triple), columns_z(), 3};
}

Eigen::Map<const Eigen::MatrixXd> Net::sensor(Index triple) const {
  return {parameters.data() + world_begin(triple) + 3 * columns_z(), columns_z(), 3};
}

Eigen::MatrixXd Net::standard_levels(const Eigen::MatrixXd& roughness) const {
  Eigen::MatrixXd standard;
  put_standard_levels(roughness, standard);
  return standard;
}

void Net::put_standard_levels(const Eigen::MatrixXd& roughness, Eigen::MatrixXd& standard) const {
  standard.resize(kChannels, roughness.cols());
  for (Index i = 0; i < roughness.cols(); ++i) {
    standard.col(i) = (level(roughness.col(i)) - level_mean.array()) / level_scale.array();
  }
  for (Index i = 0; i < standard.cols(); ++i) {
    double sum = 0.0, known = 0.0;
    for (Index c = 0; c < kChannels; ++c) {
      if (roughness(c, i) == kUnknown) continue;
      sum += standard(c, i);
      known += 1.0;
    }
    for (Index c = 0; c < kChannels; ++c) {
      if (roughness(c, i) == kUnknown) standard(c, i) = known > 0.0 ? sum / known : level_noisy[c];
    }
  }
}

void Net::denoise(Pass& pass) const {
  const Index n = pass.columns(), experts = plan_.experts;
  if (gate_size() == 0) {
    pass.clean = pass.experts;
    return;
  }
  if (plan_.dense) {
    Dense::forward(parameters.data(), pass.experts, pass.levels, pass.dense, pass.clean);
    return;
  }
  gate_.forward(parameters.data(), pass.levels, pass.gate_hidden, pass.share);
  pass.clean.resize(kChannels, n);
  for (Index i = 0; i < n; ++i) {
    for (Index c = 0; c < kChannels; ++c) {
      auto share = pass.share.col(i).segment(c * experts, experts);
      share = (share.array() - share.maxCoeff()).exp();
      share /= share.sum();
      pass.clean(c, i) = share.dot(pass.experts.col(i).segment(c * experts, experts));
    }
  }
}

void Net::features(Pass& pass) const {
  const Index n = pass.columns();
  pass.z.resize(columns_z(), n);
  pass.frames.clear();
  pass.frames.reserve(static_cast<std::size_t>(n));
  if (plan_.saturation) {
    gain_.forward(parameters.data() + gain_begin(), pass.levels, pass.gain_hidden, pass.gain);
    pass.tanh.resize(kSaturating, n);
  }
  for (Index i = 0; i < n; ++i) {
    const Instant x = instant_of(*this, pass.clean.col(i));
    const Frame& f = pass.frames.emplace_back(x, mounting);
    const Vector3d& w = f.omega;
    auto z = pass.z.col(i);
    z.head(kSmooth) << 1.0, x.segment<3>(9), x.segment<3>(3), f.velocity, w, f.alpha, w[0] * w[0],
        w[1] * w[1], w[2] * w[2], w[0] * w[1], w[1] * w[2], w[2] * w[0];
    z.head(kSmooth).array() /= unit.array();
    if (!plan_.saturation) continue;
    const Units u = units_of(x, f);
    for (Index k = 0; k < kSaturating; ++k) {
      pass.tanh(k, i) = std::tanh(u[k / kScales] * std::exp(-parameters[scale_begin() + k]));
      z[kSmooth + k] = (1.0 + pass.gain(k, i)) * pass.tanh(k, i);
    }
  }
}

void Net::product(Pass& pass) const {
  pass.out.resize(3 * plan_.triples, pass.columns());
  for (Index t = 0; t < plan_.triples; ++t) {
    pass.in_world.resize(3, pass.columns());
    pass.in_world.noalias() = world(t).transpose() * pass.z;
    pass.out.middleRows(3 * t, 3).noalias() = sensor(t).transpose() * pass.z;
    for (Index i = 0; i < pass.columns(); ++i) {
      const Frame& f = pass.frames[static_cast<std::size_t>(i)];
      pass.out.col(i).segment<3>(3 * t) += f.to_sensor * pass.in_world.col(i);
    }
  }
}

void Net::pull_back_denoise(const Pass& pass, const Eigen::MatrixXd& d_clean,
                            Eigen::VectorXd& gradient) const {
  if (gate_size() == 0) return;
  if (plan_.dense) {
    Dense::backward(parameters.data(), pass.dense, d_clean, gradient.data());
    return;
  }
  const Index experts = plan_.experts;
  Eigen::MatrixXd d_logit(pass.share.rows(), pass.columns());
  for (Index i = 0; i < pass.columns(); ++i) {
    for (Index c = 0; c < kChannels; ++c) {
      const Index first = c * experts;
      d_logit.col(i).segment(first, experts) =
          pass.share.col(i).segment(first, experts).array() * d_clean(c, i) *
          (pass.experts.col(i).segment(first, experts).array() - pass.clean(c, i));
    }
  }
  gate_.backward(parameters.data(), pass.levels, pass.gate_hidden, d_logit, gradient.data());
}

void Net::pull_back_units(const Pass& pass, Index column, const Eigen::VectorXd& dz,
                          Eigen::MatrixXd& d_gain, Eigen::VectorXd& gradient, Units& du) const {
  const Instant x = instant_of(*this, pass.clean.col(column));
  const Units u = units_of(x, pass.frames[static_cast<std::size_t>(column)]);
  for (Index k = 0; k < kSaturating; ++k) {
    const double d = dz[kSmooth + k], t = pass.tanh(k, column);
    d_gain(k, column) = d * t;
    const double inverse = std::exp(-parameters[scale_begin() + k]);
    const double slope = d * (1.0 + pass.gain(k, column)) * (1.0 - t * t) * inverse;
    du[k / kScales] += slope;
    gradient[scale_begin() + k] -= slope * u[k / kScales];
  }
}

Eigen::MatrixXd Net::pull_back_head(const Pass& pass, const Eigen::MatrixXd& d_out,
                                    Eigen::VectorXd& gradient) const {
  const Index n = pass.columns(), size = columns_z();
  Eigen::MatrixXd d_x = Eigen::MatrixXd::Zero(kChannels, n), dz = Eigen::MatrixXd::Zero(size, n);
  for (Index t = 0; t < plan_.triples; ++t) {
    const Eigen::MatrixXd in_world = world(t).transpose() * pass.z;
    Eigen::MatrixXd d_world(3, n);
    const auto d_sensor = d_out.middleRows(3 * t, 3);
    for (Index i = 0; i < n; ++i) {
      const Frame& f = pass.frames[static_cast<std::size_t>(i)];
      d_world.col(i) = f.to_sensor.transpose() * d_sensor.col(i);
      Instant g = Instant::Zero();
      f.pull_back_turn(f.to_sensor * in_world.col(i), d_sensor.col(i), g);
      d_x.col(i) += g;
    }
    double* const begin = gradient.data() + world_begin(t);
    Eigen::Map<Eigen::MatrixXd>(begin, size, 3) += pass.z * d_world.transpose();
    Eigen::Map<Eigen::MatrixXd>(begin + 3 * size, size, 3) += pass.z * d_sensor.transpose();
    dz += world(t) * d_world + sensor(t) * d_sensor;
  }
  Eigen::MatrixXd d_gain(kSaturating, n);
  for (Index i = 0; i < n; ++i) {
    const Frame& f = pass.frames[static_cast<std::size_t>(i)];
    Units du = Units::Zero();
    if (plan_.saturation) pull_back_units(pass, i, dz.col(i), d_gain, gradient, du);
    const Eigen::VectorXd s = dz.col(i).head(kSmooth).cwiseQuotient(unit);
    const Vector3d& w = f.omega;
    Vector3d d_omega = s.segment<3>(10) + du.segment<3>(6);
    d_omega += Vector3d(2.0 * w[0] * s[16] + w[1] * s[19] + w[2] * s[21],
                        2.0 * w[1] * s[17] + w[0] * s[19] + w[2] * s[20],
                        2.0 * w[2] * s[18] + w[1] * s[20] + w[0] * s[21]);
    Instant g = Instant::Zero();
    g.segment<3>(9) = s.segment<3>(1);
    g.segment<3>(3) = s.segment<3>(4) + du.head<3>();
    f.pull_back(d_omega, s.segment<3>(13), s.segment<3>(7) + du.segment<3>(3), g);
    d_x.col(i) += g;
  }
  if (plan_.saturation) {
    gain_.backward(parameters.data() + gain_begin(), pass.levels, pass.gain_hidden, d_gain,
                   gradient.data() + gain_begin());
  }
  return d_x.array().colwise() * scale.array();
}

}  // namespace dcnn::frame_tcn
