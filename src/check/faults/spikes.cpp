#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"

namespace dcnn::check {
namespace {

constexpr double kFar = 20.0;    // deviations from the neighbours
constexpr double kLonely = 0.3;  // of a spike's height: how far its neighbours are from theirs

/// Two-sided tail of Student's t with five degrees of freedom far out: noise of sensors at its
/// worst.
double heavy_tail(double z) { return 19.0 / elementary::pow(z, 5); }

/// Of single rows: lambda expected, `count` found.
double poisson_p(double lambda, int count) {
  double p = 1.0;
  for (int k = 1; k <= std::min(count, 50); ++k) p *= lambda / k;
  return std::min(1.0, p);
}

/// Of the rows that differ from their neighbours: a channel at its limit repeats one value.
double deviation_of_moving(const Eigen::VectorXd& far) {
  std::vector<double> sizes;
  for (const double value : far) {
    if (value != 0.0) sizes.push_back(std::abs(value));
  }
  return 1.4826 *
         median(Eigen::Map<Eigen::VectorXd>(sizes.data(), static_cast<Eigen::Index>(sizes.size())));
}

void find_spikes_in(const Log& log, const std::string& name, std::vector<Fault>& out) {
  const Eigen::VectorXd x = log.column(name), far = outlying(x);
  const double scale = std::max(deviation_of_moving(far), 0.5 * resolution(x));
  if (scale <= 0.0) return;
  int count = 0;
  double most = 0.0;
  Eigen::Index first = 0;
  for (Eigen::Index i = 3; i + 3 < x.size(); ++i) {
    const double height = std::abs(far[i]);
    const double beside = std::max(std::abs(x[i + 1] - x[i - 1]), std::abs(x[i + 2] - x[i - 2]));
    if (height < kFar * scale || beside > kLonely * height || x[i] == 0.0) continue;
    if (count++ == 0) first = i;
    most = std::max(most, height / scale);
  }
  if (count == 0) return;
  const double n = static_cast<double>(x.size());
  const double p =
      std::min(poisson_p(n * heavy_tail(kFar), count), poisson_p(n * heavy_tail(most), 1));
  Fault fault = fault_of(spikes_fault, posterior_of_p(2.0 * p), name,
                         std::to_string(count) + " single rows of " + name + " are up to " +
                             brief(most) + " deviations off their neighbours");
  set_interval(log, first, first + 1, fault);
  out.push_back(fault);
}

std::vector<Fault> find_spikes(const Evidence& e) {
  std::vector<Fault> out;
  if (!e.log.smooth) return out;
  for (const std::string& name : measured_columns(e.log)) find_spikes_in(e.log, name, out);
  return out;
}

}  // namespace

const FaultKind spikes_fault{"spikes", false, "remove these rows", "", find_spikes};

}  // namespace dcnn::check
