// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/locate.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "dcnn/data/fourier.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/judgement.h"

namespace dcnn {
namespace {

constexpr double kSegmentSeconds = 0.5;
constexpr int kBins = 12;

double floor_power(const std::vector<Floor>& floors, Index channel) {
  const double s = floors[static_cast<std::size_t>(channel)].deviation();
  return s * s;
}

Json axes(const Case& study, const Signals& left, const std::vector<Floor>& floors) {
  Json list = Json::array();
  std::vector<double> energy;
  double all = 0.0;
  for (Index j = 0; j < study.channel_count(); ++j) {
    // In units of the floor, so that newtons and newton-metres weigh alike.
    const double excess = std::max(0.0, mean_square(study, left, j) - floor_power(floors, j));
    list.push_back(
        {{"axis", study.targets[static_cast<std::size_t>(j)]}, {"excess_rms", std::sqrt(excess)}});
    energy.push_back(excess / std::max(1e-300, floor_power(floors, j)));
    all += energy.back();
  }
  for (std::size_t j = 0; j < energy.size(); ++j) {
    list[j]["share"] = all > 0.0 ? energy[j] / all : 0.0;
  }
  return list;
}

/// Stretches of time in which the energy of what is left stands out.
Json segments(const Case& study, const Signals& left, const std::vector<Floor>& floors) {
  struct Window {
    double begin, end, excess;
    std::size_t log;
  };
  if (study.is_static()) return Json::array();
  const Index n = std::max<Index>(4, std::llround(kSegmentSeconds / study.dt()));
  std::vector<Window> windows;
  for (std::size_t k = 0; k < left.size(); ++k) {
    const auto& motion = study.logs[k].motion;
    for (const Segment& s : inner_segments(study, k)) {
      for (Index i = s.begin; i + n <= s.end; i += n) {
        double excess = 0.0;
        for (Index j = 0; j < study.channel_count(); ++j) {
          excess += left[k].col(j).segment(i, n).squaredNorm() / static_cast<double>(n) -
                    floor_power(floors, j);
        }
        windows.push_back({motion.t(i), motion.t(i + n - 1) + study.dt(), excess, k});
      }
    }
  }
  if (windows.size() < 8) return Json::array();
  std::vector<double> sorted;
  double total = 0.0;
  for (const Window& w : windows) {
    sorted.push_back(w.excess);
    total += std::max(0.0, w.excess);
  }
  std::sort(sorted.begin(), sorted.end());
  const double middle = sorted[sorted.size() / 2];
  // Of a normal distribution, whose quartiles are 1.349 deviations apart.
  const double spread = (sorted[sorted.size() * 3 / 4] - sorted[sorted.size() / 4]) / 1.349;
  double noise = 0.0;
  for (Index j = 0; j < study.channel_count(); ++j) noise += floor_power(floors, j);
  const double high = std::max({0.0, middle + prior::kOutstanding * spread, middle + 0.25 * noise});
  std::vector<Window> found;
  for (const Window& w : windows) {
    if (w.excess <= high) continue;
    if (!found.empty() && found.back().log == w.log && w.begin - found.back().end < 0.6) {
      found.back().end = w.end;
      found.back().excess += w.excess;
    } else {
      found.push_back(w);
    }
  }
  std::sort(found.begin(), found.end(), [](auto& a, auto& b) { return a.excess > b.excess; });
  Json list = Json::array();
  for (std::size_t k = 0; k < std::min<std::size_t>(5, found.size()); ++k) {
    const Window& w = found[k];
    const double count = (w.end - w.begin) / kSegmentSeconds;
    Json entry{{"interval_s", {w.begin, w.end}},
               {"excess_rms", std::sqrt(w.excess / std::max(1.0, count))},
               {"share", w.excess / std::max(1e-300, total)}};
    if (!study.shared_clock) entry["recording"] = study.logs[w.log].motion.recording;
    list.push_back(entry);
  }
  return list;
}

/// A scalar signal at every sample, and what it is called.
std::map<std::string, std::vector<Eigen::VectorXd>> signals_of(const Case& study) {
  std::map<std::string, std::vector<Eigen::VectorXd>> signals;
  for (const Log& log : study.logs) {
    const Motion& m = log.motion;
    for (Index i = 0; i < 3; ++i) {
      const std::string axis(1, "xyz"[i]);
      signals[std::string(
                  std::vector<const char*>{"alpha", "beta", "gamma"}[static_cast<std::size_t>(i)])]
          .push_back(m.euler.col(i));
      if (m.is_static()) continue;
      signals["w_" + axis].push_back(m.w_S.col(i));
      if (m.v_B.rows() == m.samples()) signals["v_base_" + axis].push_back(m.v_B.col(i));
    }
    if (m.is_static() || m.v_B.rows() != m.samples()) continue;
    Eigen::VectorXd tool(m.samples());
    for (Index k = 0; k < m.samples(); ++k) {
      tool(k) = m.R_BS[static_cast<std::size_t>(k)].col(2).dot(m.v_B.row(k).transpose());
    }
    signals["v_z"].push_back(tool);
    signals["t"].push_back(m.t);
  }
  return signals;
}

/// Which signal's bins have means that explain what is left, and how these go.
Json regimes(const Case& study, const Signals& left, const std::vector<Floor>& floors) {
  struct Found {
    std::string signal, condition;
    double share;
  };
  std::vector<Found> found;
  double total = 0.0;
  for (Index j = 0; j < study.channel_count(); ++j) {
    for (const auto& r : left) {
      total += r.col(j).squaredNorm() - floor_power(floors, j) * static_cast<double>(r.rows());
    }
  }
  if (total <= 0.0) return Json::array();
  for (const auto& [name, parts] : signals_of(study)) {
    double low = 1e300, high = -1e300;
    for (const auto& x : parts) {
      low = std::min(low, x.minCoeff());
      high = std::max(high, x.maxCoeff());
    }
    const bool symmetric = name[0] == 'v' || name[0] == 'w';
    if (symmetric) {
      high = std::max(-low, high);
      low = -high;
    }
    if (!(high > low)) continue;
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(kBins, study.channel_count());
    Eigen::VectorXd count = Eigen::VectorXd::Zero(kBins);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      for (Index i = 0; i < parts[k].size(); ++i) {
        const auto bin = std::min<Index>(
            kBins - 1, static_cast<Index>(kBins * (parts[k](i) - low) / (high - low)));
        sum.row(bin) += left[k].row(i);
        count(bin) += 1.0;
      }
    }
    double energy = 0.0, odd = 0.0, even = 0.0;
    for (Index b = 0; b < kBins; ++b) {
      if (count(b) > 0.0) energy += sum.row(b).squaredNorm() / count(b);
      const Index mirror = kBins - 1 - b;
      if (count(b) < 1.0 || count(mirror) < 1.0) continue;
      const Eigen::RowVectorXd a = sum.row(b) / count(b), c = sum.row(mirror) / count(mirror);
      odd += (a - c).squaredNorm();
      even += (a + c).squaredNorm();
    }
    const std::string condition = !symmetric         ? "changes with it"
                                  : odd > 2.0 * even ? "sign change"
                                  : even > 2.0 * odd ? "the same in both directions"
                                                     : "changes with it";
    found.push_back({name, condition, energy / total});
  }
  std::sort(found.begin(), found.end(), [](auto& a, auto& b) { return a.share > b.share; });
  Json list = Json::array();
  double room = 1.0;
  for (std::size_t k = 0; k < std::min<std::size_t>(3, found.size()); ++k) {
    const double share = std::min(found[k].share, room);
    if (share < 0.02) break;
    room -= share;
    list.push_back(
        {{"signal", found[k].signal}, {"condition", found[k].condition}, {"share", share}});
  }
  return list;
}

Json bands(const Case& study, const Signals& left, const std::vector<Floor>& floors) {
  if (study.is_static()) return Json::array();
  const double top = 0.5 / study.dt();
  std::vector<std::pair<double, double>> edges;  // those of band_tests(), and what is above them
  for (const BandTest& band : bands_of(study)) edges.emplace_back(band.from_hz, band.to_hz);
  edges.emplace_back(edges.back().second, std::max(top, edges.back().second));
  std::vector<double> excess(edges.size(), 0.0);
  double total = 0.0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    for (const Segment& s : inner_segments(study, k)) {
      for (Index j = 0; j < study.channel_count(); ++j) {
        Eigen::VectorXd x = Eigen::VectorXd::Zero(fast_length(s.size()));
        x.head(s.size()) = left[k].col(j).segment(s.begin, s.size());
        const Eigen::VectorXd power = fourier(x).cwiseAbs2() / static_cast<double>(x.size());
        for (Index i = 0; i < power.size(); ++i) {
          const double hz = static_cast<double>(i) / (static_cast<double>(x.size()) * study.dt());
          const double noise = floors[static_cast<std::size_t>(j)].density(hz) *
                               static_cast<double>(s.size()) / static_cast<double>(x.size());
          for (std::size_t b = 0; b < edges.size(); ++b) {
            if (hz >= edges[b].first && hz < edges[b].second) {
              excess[b] += (i == 0 ? 1.0 : 2.0) * (power(i) - noise);
            }
          }
        }
      }
    }
  }
  for (double& e : excess) total += e = std::max(0.0, e);
  Json list = Json::array();
  for (std::size_t b = 0; b < edges.size(); ++b) {
    if (edges[b].first >= top) continue;
    list.push_back({{"hz", {edges[b].first, std::min(top, edges[b].second)}},
                    {"share", total > 0.0 ? excess[b] / total : 0.0}});
  }
  return list;
}

}  // namespace

Json locate(const Case& study, const Signals& left, const std::vector<Floor>& floors) {
  return {{"axes", axes(study, left, floors)},
          {"segments", segments(study, left, floors)},
          {"regimes", regimes(study, left, floors)},
          {"bands", bands(study, left, floors)}};
}

}  // namespace dcnn
