// How the noise's level varies over a recording.
#include <algorithm>
#include <cmath>

#include "diagnosis/noise_floor.h"

namespace dcnn {

std::vector<Eigen::VectorXd> noise_level(const Case& study, const Signals& residual) {
  if (study.is_static()) {
    std::vector<Eigen::VectorXd> ones;
    for (const auto& r : residual) ones.push_back(Eigen::VectorXd::Ones(r.rows()));
    return ones;
  }
  constexpr double kSeconds = 1.0, kVaries = 2.5;
  const Index n = std::max<Index>(8, std::llround(kSeconds / study.dt()));
  std::vector<Eigen::VectorXd> levels;
  std::vector<double> logs;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    const Eigen::MatrixXd& r = residual[k];
    Eigen::VectorXd level = Eigen::VectorXd::Ones(r.rows());
    for (const Segment& s : study.logs[k].motion.segments) {
      for (Index begin = s.begin; begin < s.end; begin += n) {
        const Index end = std::min(begin + n, s.end);
        double sum = 0.0, count = 0.0;
        for (Index j = 0; j < r.cols(); ++j) {
          for (Index i = std::max(begin, s.begin + 2); i < end; ++i, ++count) {
            sum += std::abs(r(i, j) - 2.0 * r(i - 1, j) + r(i - 2, j));
          }
        }
        const double mean = count > 0.0 ? sum / count : 0.0;
        level.segment(begin, end - begin).setConstant(mean);
        if (mean > 0.0 && end - begin == n) logs.push_back(std::log(mean));
      }
    }
    levels.push_back(level);
  }
  double mean = 0.0, square = 0.0;
  for (const double x : logs)
    mean += x / static_cast<double>(std::max<std::size_t>(1, logs.size()));
  for (const double x : logs) square += (x - mean) * (x - mean);
  const double spread =
      logs.size() > 3 ? std::sqrt(square / static_cast<double>(logs.size() - 1)) : 0.0;
  // Mean of n·channels absolute second differences of white noise: relative spread 0.756·sqrt(2)/
  // sqrt(n·channels), the second factor for their correlation.
  const double expected =
      1.07 / std::sqrt(static_cast<double>(n * std::max<Index>(1, study.channel_count())));
  double power = 0.0, rows = 0.0;
  for (auto& level : levels) {
    if (spread <= kVaries * expected) level.setOnes();
    level = level.cwiseMax(1e-3 * std::exp(mean));
    power += level.squaredNorm();
    rows += static_cast<double>(level.size());
  }
  for (auto& level : levels) level /= std::sqrt(power / std::max(1.0, rows));
  return levels;
}

}  // namespace dcnn
