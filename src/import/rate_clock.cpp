// SPDX-License-Identifier: Apache-2.0
#include "import/rate_clock.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "data/median.h"
#include "import/roles.h"

namespace dcnn {
namespace {

constexpr double kLeastCorrelation = 0.8;  // of the changes with the rate: else a column of noise
constexpr double kAgree = 0.1;             // relative, of each pair with the median

/// The rate that belongs to an angle or position; empty where none does.
std::string rate_of(const std::string& role) {
  if (role.starts_with("q:")) return "qd:" + role.substr(2);
  return role == "x" || role == "y" || role == "z" ? "v" + role : "";
}

std::optional<double> seconds_of_pair(const std::vector<double>& x, const std::vector<double>& rate,
                                      const std::vector<double>& clock) {
  double change = 0.0, way = 0.0, xx = 0.0, xv = 0.0, vv = 0.0;
  for (std::size_t k = 1; k + 1 < x.size() && k + 1 < rate.size(); ++k) {
    const double span = clock.empty() ? 2.0 : clock[k + 1] - clock[k - 1];
    const double dx = x[k + 1] - x[k - 1], v = rate[k] * span;
    if (!std::isfinite(dx) || !std::isfinite(v) || span <= 0.0) continue;
    change += std::copysign(1.0, v) * dx;
    way += std::abs(v);
    xx += dx * dx, xv += dx * v, vv += v * v;
  }
  if (way <= 0.0 || change <= 0.0 || xv < kLeastCorrelation * std::sqrt(xx * vv)) {
    return std::nullopt;
  }
  return change / way;
}

}  // namespace

std::optional<double> seconds_by_rates(const LogStream& stream, const std::vector<double>& clock) {
  std::map<std::string, const LogChannel*> columns;
  for (const LogChannel& channel : stream.channels) {
    if (channel.values.empty()) continue;
    const std::string role = role_of(stream, channel.name);
    if (!role.empty()) columns.emplace(role, &channel);
  }
  std::vector<double> seconds;
  for (const auto& [role, channel] : columns) {
    const auto rate = columns.find(rate_of(role));
    if (rate == columns.end()) continue;
    const auto pair = seconds_of_pair(channel->values, rate->second->values, clock);
    if (pair) seconds.push_back(*pair);
  }
  if (seconds.empty()) return std::nullopt;
  const double middle = median(seconds);
  const bool agree = std::all_of(seconds.begin(), seconds.end(),
                                 [&](double s) { return std::abs(s - middle) < kAgree * middle; });
  return agree ? std::optional(middle) : std::nullopt;
}

}  // namespace dcnn
