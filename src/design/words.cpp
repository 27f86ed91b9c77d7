// SPDX-License-Identifier: Apache-2.0
#include "design/words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "data/reversals.h"
#include "dcnn/core/number.h"
#include "dcnn/physics/effect_words.h"

namespace dcnn::design {
namespace {

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100.0 * share);
  return text;
}

/// A size or probability of which nobody needs more than that it is next to nothing.
std::string or_less(double value) {
  constexpr double kLeast = 0.01;
  return value < kLeast ? "less than 0.01" : brief(value);
}

/// What the motion decides of the pair that it was made for, and how probably of all.
std::string verdict_words(const Design& design) {
  constexpr double kIndistinct = 1.0;  // deviation of the noise over all rows
  const Verdict& v = design.verdicts.front();
  const std::string one = words_of_structure(v.one), other = words_of_structure(v.other);
  if (v.separation < kIndistinct) {
    return "; no motion that was tried within these limits tells " + one + " from " + other +
           ": they differ by less than the noise";
  }
  std::string words = "; if it is " + one + ", then " + other + " is " + brief(v.separation) +
                      " deviations of the noise away";
  if (design.probability)
    words += ", and with probability " + or_less(*design.probability) + " one model is left";
  return words;
}

/// "x over 0.2 m at up to 0.25 m/s with 24 reversals", the most moved first.
std::vector<std::string> coordinate_words(const Played& played) {
  constexpr double kTurn = 0.01;  // of its range, by which a coordinate turns back
  const char* const names[] = {"x", "y", "z", "alpha", "beta", "gamma"};
  std::vector<std::pair<double, std::string>> list;
  const double dt = played.motion.dt;
  double largest[2] = {0.0, 0.0};
  for (Index k = 0; k < 6; ++k) {
    const double range = played.pose.col(k).maxCoeff() - played.pose.col(k).minCoeff();
    largest[k / 3] = std::max(largest[k / 3], range);
  }
  for (Index k = 0; k < 6; ++k) {
    constexpr double kHardly = 0.05;  // of the most moved of the three
    const Eigen::VectorXd x = played.pose.col(k);
    const double range = x.maxCoeff() - x.minCoeff();
    if (!(range > kHardly * largest[k / 3]) || range < 1e-6) continue;
    const double speed = (x.tail(x.size() - 1) - x.head(x.size() - 1)).cwiseAbs().maxCoeff() / dt;
    const std::string unit = k < 3 ? "m" : "rad";
    std::ostringstream words;
    words << names[k] << " over " << brief(range) << " " << unit << " at up to " << brief(speed)
          << " " << unit << "/s with " << reversals(x, kTurn) << " reversals";
    list.emplace_back(-range / largest[k / 3], words.str());
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> words;
  for (const auto& entry : list) words.push_back(entry.second);
  return words;
}

}  // namespace

std::string limit_words(const Usage& usage) { return usage.limit + " " + percent(usage.share); }

std::string motion_words(const Played& played, const Question& question, const Design& design) {
  std::ostringstream out;
  out << "move ";
  const auto parts = coordinate_words(played);
  for (std::size_t k = 0; k < parts.size(); ++k) out << (k > 0 ? ", " : "") << parts[k];
  if (parts.empty()) out << "nothing: the limits leave no room";
  if (!design.verdicts.empty()) out << verdict_words(design);
  if (question.unknown > 0.5)
    out << "; what no name describes is seen in all directions and speeds of these limits";
  return out.str();
}

Json next_motion(const Design& design, double seconds) {
  constexpr double kDecided = 0.9;  // of the mass on one structure
  if (design.verdicts.empty() && design.unknown < 1.0 - kDecided) return nullptr;
  Json separates = Json::array();
  if (design.verdicts.empty()) {
    separates = {design.chosen, "unknown"};
  } else {
    separates = {design.verdicts[0].one, design.verdicts[0].other};
  }
  return {{"separates", separates},
          {"words", design.words},
          {"seconds", seconds},
          {"probability", design.probability ? Json(*design.probability) : Json()}};
}

Json to_json(const Design& design, double seconds) {
  Json pairs = Json::array();
  for (const Verdict& v : design.verdicts) {
    pairs.push_back({{"right", v.one},
                     {"rival", v.other},
                     {"separation", v.separation},
                     {"probability", v.probability}});
  }
  return {{"next_motion", next_motion(design, seconds)},
          {"pairs", pairs},
          {"unknown", {{"probability", design.unknown}, {"nats_per_state", design.information}}},
          {"limits", design.limits},
          {"greatest_use", design.greatest_use}};
}

std::string to_text(const Design& design) {
  std::ostringstream out;
  for (const Verdict& v : design.verdicts) {
    out << "if          it is " << words_of_structure(v.one) << ", not "
        << words_of_structure(v.other) << ": " << or_less(v.separation)
        << " deviations apart, left alone with probability " << or_less(v.probability) << "\n";
  }
  out << "unknown     probability " << or_less(design.unknown) << ", " << brief(design.information)
      << " nats for each state that a law may depend on\n";
  out << "limits      ";
  for (std::size_t k = 0; k < design.limits.size(); ++k)
    out << (k > 0 ? ", " : "") << design.limits[k];
  out << "\nmotion      " << design.words << "\n";
  if (design.probability)
    out << "decides     with probability " << or_less(*design.probability) << "\n";
  return out.str();
}

}  // namespace dcnn::design
