// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/judgement.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/linear_algebra.h"
#include "dcnn/data/fourier.h"

namespace dcnn {
namespace {

constexpr int kFlips = 999;
constexpr double kFlipSeconds = 1.0;
constexpr double kConstancySeconds = 8.0;
constexpr Index kShifts = 12;

/// Runs of rows of one channel that follow each other in time: the first, and one past the last.
std::vector<std::pair<Index, Index>> runs_of(const Setting& setting) {
  const auto& info = setting.whitener.row_info();
  const double dt = setting.whitener.block_seconds();
  std::vector<std::pair<Index, Index>> runs;
  for (std::size_t begin = 0; begin < info.size();) {
    std::size_t end = begin + 1;
    while (end < info.size() && info[end].channel == info[begin].channel &&
           info[end].log == info[begin].log && info[end].t - info[end - 1].t < 1.5 * dt) {
      ++end;
    }
    runs.emplace_back(static_cast<Index>(begin), static_cast<Index>(end));
    begin = end;
  }
  return runs;
}

}  // namespace

std::vector<std::vector<Index>> time_blocks(const Setting& setting, double seconds) {
  std::map<std::pair<std::uint32_t, std::int64_t>, std::vector<Index>> blocks;
  const auto& info = setting.whitener.row_info();
  for (std::size_t row = 0; row < info.size(); ++row) {
    if (setting.mask(static_cast<Index>(row)) == 0.0) continue;
    const auto number = static_cast<std::int64_t>(std::floor(info[row].t / seconds));
    blocks[{info[row].log, number}].push_back(static_cast<Index>(row));
  }
  std::vector<std::vector<Index>> list;
  for (auto& [key, rows] : blocks) list.push_back(std::move(rows));
  return list;
}

Eigen::MatrixXd normal_inverse(const Eigen::MatrixXd& gram) {
  return solve_gram(gram, Eigen::MatrixXd::Identity(gram.rows(), gram.cols()), 1e-11);
}

std::pair<Index, Index> tangent_columns(const JointFit& fit, std::size_t member) {
  Index first = 0;
  for (std::size_t m = 0; m < member; ++m) {
    first += fit.members[m].coordinates();
  }
  const Member& own = fit.members[member];
  return {first, own.fixed ? 0 : own.coordinates()};
}

std::vector<BandTest> bands_of(const Case& study) {
  std::vector<BandTest> bands{
      {0.0, 0.5, 0, 0}, {0.5, 2, 0, 0}, {2, 5, 0, 0}, {5, 12, 0, 0}, {12, 25.5, 0, 0}};
  for (BandTest& band : bands) {
    band.from_hz *= study.shown_hz() / 20.0;
    band.to_hz *= study.shown_hz() / 20.0;
  }
  return bands;
}

std::vector<BandTest> band_tests(const Setting& setting, const Eigen::VectorXd& residual) {
  std::vector<BandTest> bands = bands_of(setting.study);
  std::vector<double> sum(bands.size(), 0.0);
  const auto& info = setting.whitener.row_info();
  const double dt = setting.whitener.block_seconds();
  for (const auto& [begin, end] : runs_of(setting)) {
    const Index n = end - begin;
    const auto channel = static_cast<Index>(info[static_cast<std::size_t>(begin)].channel);
    const Eigen::VectorXd x = residual.segment(begin, n);
    const double kept = setting.mask.segment(begin, n).sum();
    if (n >= 16 && kept > 8.0) {
      const Eigen::VectorXd power = fourier(x).cwiseAbs2() / kept;
      for (Index k = 0; k < power.size(); ++k) {
        const bool single = k == 0 || 2 * k == n;
        const double hz = static_cast<double>(k) / (static_cast<double>(n) * dt);
        const double expected = setting.whitener.expected_density(channel, hz);
        for (std::size_t b = 0; b < bands.size(); ++b) {
          if (hz < bands[b].from_hz || hz >= bands[b].to_hz) continue;
          sum[b] += (single ? 1.0 : 2.0) * power(k) / expected;
          bands[b].dof += single ? 1.0 : 2.0;
        }
      }
    }
  }
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const double dof = bands[b].dof;
    bands[b].excess = sum[b] - dof;
    bands[b].z = dof > 0.0 ? bands[b].excess / std::sqrt(2.0 * dof) : 0.0;
  }
  return bands;
}

double loudest(const std::vector<BandTest>& bands) {
  double loud = 1.0;
  for (const BandTest& band : bands) {
    if (band.stands_out()) loud = std::max(loud, band.loudness());
  }
  return loud;
}

double left_over(const std::vector<BandTest>& bands) {
  double sum = 0.0;
  for (const BandTest& band : bands) sum += band.stands_out() ? band.excess : 0.0;
  return sum;
}

bool is_alarming(const std::vector<BandTest>& bands, double explained, double least) {
  return std::any_of(bands.begin(), bands.end(), [&](const BandTest& band) {
    const bool plain = band.excess > prior::kPlainChiSquare;
    const double share = plain ? prior::kPlainRemainder : prior::kRemainder;
    return band.stands_out() && band.excess > std::max(share * explained, least);
  });
}

Eigen::MatrixXd shifted_in_time(const Setting& setting, const Eigen::VectorXd& residual) {
  Eigen::MatrixXd shifted(residual.size(), kShifts);
  for (const auto& [begin, end] : runs_of(setting)) {
    for (Index s = 0; s < kShifts; ++s) {
      const Index n = end - begin, by = (s + 1) * n / (kShifts + 1);
      shifted.col(s).segment(begin, n - by) = residual.segment(begin + by, n - by);
      shifted.col(s).segment(end - by, by) = residual.segment(begin, by);
    }
  }
  return shifted;
}

double overdispersion(std::vector<double> scores, double freedom) {
  const auto quartile = scores.begin() + static_cast<std::ptrdiff_t>(scores.size() / 4);
  std::nth_element(scores.begin(), quartile, scores.end());
  return std::max(1.0, *quartile / freedom);
}

std::vector<Constancy> constancy(const Setting& setting, const JointFit& fit) {
  std::vector<Constancy> list(fit.members.size());
  const auto blocks = time_blocks(setting, kConstancySeconds);
  Eigen::MatrixXd residuals(fit.residual.size(), kShifts + 1);
  residuals << fit.residual, shifted_in_time(setting, fit.residual);
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    const auto [first, count] = tangent_columns(fit, m);
    if (count == 0) continue;
    Eigen::RowVectorXd scores = Eigen::RowVectorXd::Zero(kShifts + 1);
    double terms = 0.0;
    const Eigen::MatrixXd columns = fit.tangent.middleCols(first, count);
    const Eigen::VectorXd whole = columns.colwise().squaredNorm();
    for (const auto& rows : blocks) {
      const Eigen::MatrixXd J = columns(rows, Eigen::all);
      const Eigen::MatrixXd g = J.transpose() * residuals(rows, Eigen::all);
      for (Index k = 0; k < count; ++k) {  // column by column: a block rarely tells them apart
        const double energy = J.col(k).squaredNorm();
        if (energy <= 1e-4 * whole(k) / static_cast<double>(blocks.size())) continue;
        scores += g.row(k).cwiseAbs2() / energy;
        terms += 1.0;
      }
    }
    const double score = scores(0), dof = terms - static_cast<double>(count);
    if (dof < 3.0) continue;
    list[m].ratio = score / dof;
    list[m].excess = score - dof;
    list[m].z = (score - dof) / std::sqrt(2.0 * dof);
    list[m].overdispersion =
        overdispersion({scores.data() + 1, scores.data() + scores.size()}, terms);
  }
  return list;
}

double least_flip_p_value(const Setting& setting) {
  return std::ldexp(2.0, -static_cast<int>(time_blocks(setting, kFlipSeconds).size()));
}

double flip_p_value(const Setting& setting, const JointFit& fit, std::size_t member) {
  const auto [first, count] = tangent_columns(fit, member);
  if (count == 0) return 1.0 / (kFlips + 1.0);
  Eigen::MatrixXd others(fit.tangent.rows(), fit.tangent.cols() - count);
  others << fit.tangent.leftCols(first), fit.tangent.rightCols(fit.tangent.cols() - first - count);
  const Eigen::MatrixXd basis = orthonormal(others), own = fit.tangent.middleCols(first, count);
  const Eigen::MatrixXd c = own - basis * (basis.transpose() * own);
  // The residual as if the member were not there: back along its own amplitudes.
  Eigen::VectorXd back = Eigen::VectorXd::Zero(count);
  const Member& m = fit.members[member];
  back.head(m.amplitudes.size()) = m.amplitudes;
  if (m.amplitudes.size() == 0) back.setOnes();
  const Eigen::VectorXd r = fit.residual + c * back;
  const auto blocks = time_blocks(setting, kFlipSeconds);
  Eigen::MatrixXd scores(static_cast<Index>(blocks.size()), count);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    scores.row(static_cast<Index>(b)) =
        (c(blocks[b], Eigen::all).transpose() * r(blocks[b])).transpose();
  }
  // What chi-square falls by where the member's columns are fitted to blocks of these signs. (By
  // the covariance of the blocks' scores few blocks, as of some seconds, tell nothing.)
  const Eigen::MatrixXd inverse = normal_inverse(c.transpose() * c);
  const auto statistic = [&](const Eigen::VectorXd& sum) { return sum.dot(inverse * sum); };
  const double actual = statistic(scores.colwise().sum().transpose());
  Rng rng({0x5167u, static_cast<std::uint64_t>(member)});
  int above = 0;
  for (int flip = 0; flip < kFlips; ++flip) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(count);
    for (Index b = 0; b < scores.rows(); ++b) {
      sum += (rng.bits() & 1u ? 1.0 : -1.0) * scores.row(b).transpose();
    }
    above += statistic(sum) >= actual;
  }
  return (above + 1.0) / (kFlips + 1.0);
}

}  // namespace dcnn
