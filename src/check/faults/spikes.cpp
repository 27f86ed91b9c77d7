#include <algorithm>
#include <cmath>

#include "check/rows.h"
#include "core/elementary.h"
#include "data/median.h"

namespace dcnn::check {
namespace {

constexpr double kLeast = 8.0;   // deviations from the neighbours: nearer ones show nothing
constexpr double kLonely = 0.3;  // of a spike's height: how far its neighbours are apart

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
  return kDeviationOfMedian *
         median(Eigen::Map<Eigen::VectorXd>(sizes.data(), static_cast<Eigen::Index>(sizes.size())));
}

struct Spike {
  double height = 0.0;  ///< in deviations
  Eigen::Index row = 0;
};

/// Single rows far from their neighbours, the farthest first.
std::vector<Spike> lonely_rows(const Eigen::VectorXd& x, const Eigen::VectorXd& far, double scale) {
  std::vector<Spike> spikes;
  for (Eigen::Index i = 3; i + 3 < x.size(); ++i) {
    const double height = std::abs(far[i]);
    const Eigen::Vector4d near(x[i - 2], x[i - 1], x[i + 1], x[i + 2]);
    const double beside = near.maxCoeff() - near.minCoeff();
    if (height < kLeast * scale || beside > kLonely * height || x[i] == 0.0) continue;
    spikes.push_back({height / scale, i});
  }
  std::sort(spikes.begin(), spikes.end(),
            [](const Spike& a, const Spike& b) { return a.height > b.height; });
  return spikes;
}

/// So many rows so far out, for the number that noise makes least likely.
void find_spikes_in(const Log& log, const std::string& name, std::vector<Fault>& out) {
  const Eigen::VectorXd x = log.column(name), far = outlying(x);
  const double scale = std::max(deviation_of_moving(far), 0.5 * resolution(x));
  if (scale <= 0.0) return;
  const std::vector<Spike> spikes = lonely_rows(x, far, scale);
  const auto n = static_cast<double>(x.size());
  double least = 1.0;
  std::size_t count = 0;
  for (std::size_t k = 1; k <= spikes.size(); ++k) {
    const double p = poisson_p(n * heavy_tail(spikes[k - 1].height), static_cast<int>(k));
    if (p < least) least = p, count = k;
  }
  if (count == 0) return;
  Eigen::Index first = spikes[0].row;
  for (std::size_t k = 1; k < count; ++k) first = std::min(first, spikes[k].row);
  // As many numbers of rows were tried as there are rows so far out.
  const double p = std::min(1.0, static_cast<double>(spikes.size()) * least);
  Fault fault =
      fault_of(spikes_fault, posterior_of_p(p), name,
               std::to_string(count) + (count == 1 ? " single row of " : " single rows of ") +
                   name + (count == 1 ? " is " : " are up to ") + brief(spikes[0].height) +
                   " deviations off " + (count == 1 ? "its" : "their") + " neighbours");
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
