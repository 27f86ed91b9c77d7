// SPDX-License-Identifier: Apache-2.0
#include "data/reflected.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/linear_algebra.h"
#include "dcnn/data/fourier.h"

namespace dcnn {
namespace {

constexpr double kPadSeconds = 2.0;
constexpr double kEndSeconds = 1.0;  // in which what is taken out at an end decays
/// Periods of the cut-off over which a quartic is fitted at an end, the longest first.
constexpr double kPeriods[] = {2.5, 1.6, 1.0};
constexpr Index kFewestOfQuartic = 8;  // samples, beside five numbers

/// A quartic through the first of some samples.
struct Quartic {
  double second;    ///< derivative at the first sample, 1/s^2
  double variance;  ///< of what it leaves
  double dof;
};

Quartic quartic_of(const Eigen::VectorXd& x, double dt) {
  const Index n = x.size();
  const Eigen::ArrayXd u = Eigen::ArrayXd::LinSpaced(n, 0.0, 1.0);
  Eigen::MatrixXd A(n, 5);
  A.col(0).setOnes();
  for (Index k = 1; k < A.cols(); ++k) A.col(k) = A.col(k - 1).cwiseProduct(u.matrix());
  const Eigen::VectorXd c = solve_symmetric(A.transpose() * A, A.transpose() * x);
  const double seconds = dt * static_cast<double>(n - 1), dof = static_cast<double>(n - A.cols());
  return {2.0 * c(2) / (seconds * seconds), (x - A * c).squaredNorm() / dof, dof};
}

/// The second derivative [1/s^2] at the first sample of a signal that is low-passed at this
/// frequency: of the quartic over the longest stretch that leaves no more than the shortest does,
/// give or take three deviations of a variance (Lepski 1991): noise is averaged for as long as the
/// motion allows.
double bend(const Eigen::VectorXd& x, double dt, double cutoff_hz) {
  const auto samples = [&](double periods) {
    return std::min<Index>(x.size() / 3, std::llround(periods / (cutoff_hz * dt)));
  };
  const Index shortest = std::max(kFewestOfQuartic, samples(kPeriods[2]));
  if (x.size() < 3 * kFewestOfQuartic) return 0.0;
  const Quartic sure = quartic_of(x.head(shortest), dt);
  const double most = sure.variance * (1.0 + 3.0 * std::sqrt(2.0 / sure.dof));
  for (const double periods : kPeriods) {
    const Index n = samples(periods);
    if (n <= shortest) break;
    const Quartic longer = quartic_of(x.head(n), dt);
    if (longer.variance <= most) return longer.second;
  }
  return sure.second;
}

}  // namespace

EndCurves::EndCurves(const Eigen::Ref<const Eigen::VectorXd>& x, double dt, double cutoff_hz)
    : decay(x.size()) {
  first = bend(x, dt, cutoff_hz);
  last = bend(x.reverse(), dt, cutoff_hz);
  for (Index i = 0; i < decay.size(); ++i) {
    decay(i) = elementary::exp(-dt * static_cast<double>(i) / kEndSeconds);
  }
}

Eigen::VectorXd EndCurves::derivative(int k) const {
  const double scale = elementary::pow(kEndSeconds, 2 - k);
  return scale * ((k % 2 ? -first : first) * decay + last * decay.reverse());
}

Padded pad_oddly(const Eigen::Ref<const Eigen::VectorXd>& x, double dt) {
  const Index n = x.size();
  Padded padded;
  padded.pad = std::min<Index>(n - 1, std::llround(kPadSeconds / dt));
  const Index length = n + 2 * padded.pad;
  padded.values.setZero(fast_length(length));
  padded.values.segment(padded.pad, n) = x;
  for (Index k = 1; k <= padded.pad; ++k) {
    padded.values(padded.pad - k) = 2.0 * x(0) - x(k);
    padded.values(padded.pad + n - 1 + k) = 2.0 * x(n - 1) - x(n - 1 - k);
  }
  const double first = padded.values(0), last = padded.values(length - 1);
  padded.slope = length > 1 ? (last - first) / static_cast<double>(length - 1) : 0.0;
  for (Index k = 0; k < length; ++k) {
    padded.values(k) -= first + padded.slope * static_cast<double>(k);
  }
  padded.level = first + padded.slope * static_cast<double>(padded.pad);
  return padded;
}

}  // namespace dcnn
