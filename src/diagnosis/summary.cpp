// SPDX-License-Identifier: Apache-2.0
// The diagnosis in a sentence.
#include <algorithm>
#include <cmath>

#include "dcnn/diagnosis/diagnose.h"
#include "dcnn/physics/effect_words.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/plain_findings.h"
#include "diagnosis/words.h"

namespace dcnn {
namespace {

/// Whether any of a channel was held out (of a joint that stands still nothing may be).
bool is_held_out(const Json& fit, std::size_t j) {
  const Json& errors = fit["holdout_rmse_after"];
  return !errors.is_null() && !errors[j].is_null();
}

/// The channel on which the findings gain most.
std::size_t telling_channel(const Json& fit) {
  std::size_t best = 0;
  double most = -1.0;
  for (std::size_t j = 0; j < fit["holdout_rmse_before"].size(); ++j) {
    if (!is_held_out(fit, j)) continue;
    const double gain = fit["holdout_rmse_before"][j].get<double>() /
                        std::max(1e-12, fit["holdout_rmse_after"][j].get<double>());
    if (gain > most) most = gain, best = j;
  }
  return best;
}

/// "falls from 0.31 to 0.04 N": the held-out error of a channel, in words.
std::string change_of(const Json& report, std::size_t j) {
  const Json& fit = report["fit"];
  const auto unit = unit_text(report["units"][j].get<std::string>());
  const double before = fit["holdout_rmse_before"][j], after = fit["holdout_rmse_after"][j];
  const std::string a = brief(before), b = brief(after);
  if (a == b) return "stays at " + a + " " + unit;
  return (after < before ? "falls from " : "rises from ") + a + " to " + b + " " + unit;
}

/// The channels that got worse, and the one that is left farthest above its noise, where that is
/// not the one that was named already.
std::string other_channels(const Json& report, std::size_t named) {
  const Json& fit = report["fit"];
  std::string text;
  double most = prior::kMostOverNoise;
  std::size_t worst = named;
  for (std::size_t j = 0; j < report["targets"].size(); ++j) {
    if (!is_held_out(fit, j)) continue;
    const double before = fit["holdout_rmse_before"][j], after = fit["holdout_rmse_after"][j];
    const double noise = heldout_noise(fit)[j];
    if (j != named && after > before && brief(after) != brief(before)) {
      text += "; that of " + report["targets"][j].get<std::string>() + " " + change_of(report, j);
    } else if (after > most * noise) {
      most = after / noise, worst = j;
    }
  }
  if (worst == named) return text;
  return text + "; that of " + report["targets"][worst].get<std::string>() + " " +
         change_of(report, worst) + ", " + brief(most) + " times its noise";
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// Whether the held-out error is, to half a percent, the same without it: a contact in a recording
/// of the fit, or a law that the held-out motion does not show.
bool is_without_effect(const Json& finding) {
  const Json& gain = finding["holdout_gain"];
  return !gain.is_null() && std::abs(gain.get<double>()) < prior::kLeastHeldOutGain;
}

/// " (held-out tx and tz speak against it)", of a finding that other channels bear out.
std::string against(const Json& finding) {
  const Json channels = finding.value("against", Json::array());
  if (channels.empty()) return "";
  std::string names;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    names += (k == 0                    ? ""
              : k + 1 < channels.size() ? ", "
                                        : " and ") +
             channels[k].get<std::string>();
  }
  return " (held-out " + names + (channels.size() == 1 ? " speaks" : " speak") + " against it)";
}

/// A finding in words, with what it shares its probability with where it is not itself the likelier
/// half: "either dry friction of 0.4 N (30 %) or presliding (40 %), which these recordings do not
/// tell apart".
std::string with_equals(const Json& finding) {
  const std::string words = finding["words"];
  const Json own = finding.value("confidence", Json());
  const Json shared = finding.value("shared_with", Json::object());
  if (own.is_null() || own.get<double>() >= 0.5 || shared.empty() || is_doubtful(finding)) {
    return words;
  }
  std::vector<std::pair<double, std::string>> others;
  const std::string axis = finding["axis"].is_string() ? finding["axis"].get<std::string>() : "";
  for (const auto& [name, share] : shared.items()) {
    others.emplace_back(share.get<double>(), words_of_effect(name, axis));
  }
  std::sort(others.rbegin(), others.rend());
  const auto percent = [](double share) { return " (" + brief(100.0 * share) + " %)"; };
  std::string text = "either " + words + percent(own);
  for (const auto& [share, name] : others) text += " or " + name + percent(share);
  return text + ", which these recordings do not tell apart";
}

struct Missing {
  std::string words;     ///< findings and what has no name
  std::string others;    ///< findings of which the held-out error does not tell
  std::string doubtful;  ///< findings that are rather wrong than right
};

Missing what_is_missing(const Json& report) {
  const bool arm = report.contains("arm");  // which says in a few words what is on many joints
  std::string text, others, doubtful;
  for (const Json& finding : in_lines(report["findings"])) {
    if (arm && !is_doubtful(finding)) continue;
    std::string& list = is_doubtful(finding)         ? doubtful
                        : is_without_effect(finding) ? others
                                                     : text;
    list += (list.empty() ? "" : "; ") + with_equals(finding) + against(finding);
  }
  if (arm) return {capitalised(report["arm"]["words"].get<std::string>()), "", doubtful};
  const Json& unnamed = report["unnamed"];
  if (!unnamed["words"].is_null()) {
    const char* const join = unnamed.value("suffices", false) ? "; " : "; and ";
    text += (text.empty() ? "" : join) + unnamed["words"].get<std::string>();
  }
  if (text.empty() && others.empty() && !doubtful.empty()) {
    return {"Nothing that was found is established, each rather wrong than right: " + doubtful, "",
            ""};
  }
  if (!text.empty() || others.empty()) return {capitalised(text), others, doubtful};
  return {capitalised(others) + ", without effect on the held-out error", "", doubtful};
}

/// Targets that vary above their noise, of whose variation the simulator as given explains nothing,
/// and how many do vary.
std::pair<std::vector<std::string>, std::size_t> unexplained_targets(const Json& report) {
  const Json& fit = report["fit"];
  std::pair<std::vector<std::string>, std::size_t> result;
  const Json explained = fit.value("holdout_explained_before", Json());
  for (std::size_t j = 0; j < explained.size(); ++j) {
    if (explained[j].is_null()) continue;
    const double measured = fit["holdout_rms_measured"][j], noise = heldout_noise(fit)[j];
    if (measured <= prior::kVaries * noise) continue;
    ++result.second;
    if (explained[j].get<double>() <= 0.0) result.first.push_back(report["targets"][j]);
  }
  return result;
}

/// A sentence on a simulator that a constant is as good as.
std::string worthless_part(const std::vector<std::string>& targets) {
  std::string names;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    names += (k == 0 ? "" : k + 1 < targets.size() ? ", " : " and ") + targets[k];
  }
  return "The given simulator explains nothing of how " + names +
         (targets.size() == 1 ? " varies" : " vary") +
         " on held-out data: a constant errs no more. ";
}

/// A sentence on findings that are rather wrong than right; empty where there are none.
std::string doubtful_part(const Missing& missing) {
  if (missing.doubtful.empty()) return "";
  return " Not established, each rather wrong than right: " + missing.doubtful + ".";
}

/// The headline where nothing was held out.
std::string headline_without(const Json& report) {
  const bool consistent = report["verdict"] == "consistent";
  const Missing missing =
      consistent ? Missing{"Nothing is missing that these recordings could show", "", ""}
                 : what_is_missing(report);
  return missing.words +
         ". Nothing was held out (the recordings are too short, or without time), so the error on "
         "new data is not known." +
         doubtful_part(missing);
}

/// "the sensor's noise is 0.02 N"; where the error that is left bounds it, no more is known of it.
/// It is not all of an error in which something without a name remains.
std::string noise_words(const Json& report, std::size_t j) {
  constexpr double kSame = 1e-9;  // of it
  const Json& fit = report["fit"];
  const double noise = heldout_noise(fit)[j];
  if (noise >= (1.0 - kSame) * fit["holdout_rmse_after"][j].get<double>()) {
    const Json remains = report["unnamed"].value("remains", Json::array());
    return j < remains.size() && remains[j] == true
               ? "how much of it is the sensor's noise is not known"
               : "all of it may be the sensor's noise";
  }
  return "the sensor's noise is " + brief(noise) + " " +
         unit_text(report["units"][j].get<std::string>());
}

/// Where nothing is missing: the channel that is left farthest above its noise.
std::string consistent(const Json& report) {
  const Json& fit = report["fit"];
  const auto ratio = [&](std::size_t j) {
    return fit["holdout_rmse_after"][j].get<double>() /
           std::max(1e-300, heldout_noise(fit)[j].get<double>());
  };
  std::size_t worst = 0;
  double most = 0.0;
  for (std::size_t j = 0; j < report["targets"].size(); ++j) {
    if (is_held_out(fit, j) && ratio(j) > most) most = ratio(j), worst = j;
  }
  const auto number = [&](const Json& values) {
    return brief(values[worst].get<double>()) + " " +
           unit_text(report["units"][worst].get<std::string>());
  };
  const std::string target = report["targets"][worst].get<std::string>();
  return "Nothing is missing: the simulator leaves " + number(fit["holdout_rmse_after"]) +
         " on held-out " + target + "; " + noise_words(report, worst) +
         (most > prior::kMostOverNoise ? ". The noise of the measured motion, or what the "
                                         "fitted recordings leave as well, makes the rest."
                                       : ".");
}

/// Where something simpler does better than all that was found, on any channel: a constant, or the
/// simulator with its own numbers refitted.
std::string what_does_better(const Json& report) {
  const Json& fit = report["fit"];
  const std::pair<const char*, const char*> rivals[] = {
      {"holdout_rms_measured", "A constant"},
      {"holdout_rmse_parameters", "The simulator with its parameters refitted"}};
  std::string text;
  for (const auto& [key, words] : rivals) {
    const Json errors = fit.value(key, Json());
    std::string channels;
    for (std::size_t j = 0; j < errors.size(); ++j) {
      if (!is_held_out(fit, j)) continue;
      const double rival = errors[j], after = fit["holdout_rmse_after"][j];
      if (rival >= after || brief(rival) == brief(after)) continue;
      channels += (channels.empty() ? "" : ", ") + brief(rival) + ' ' +
                  unit_text(report["units"][j].get<std::string>()) + " of " +
                  report["targets"][j].get<std::string>();
    }
    if (!channels.empty()) text += std::string(" ") + words + " leaves less: " + channels + '.';
  }
  return text;
}

/// What is missing, and what it is worth.
std::string answer(const Json& report) {
  const Json& fit = report["fit"];
  if (fit["holdout_rmse_before"].is_null()) return headline_without(report);
  const std::size_t j = telling_channel(fit);
  if (report["verdict"] == "consistent") return consistent(report);
  const Missing missing = what_is_missing(report);
  return missing.words + ". The hold-out error of " + report["targets"][j].get<std::string>() +
         " " + change_of(report, j) + "; " + noise_words(report, j) + other_channels(report, j) +
         "." +
         (missing.others.empty() ? ""
                                 : " In the fitted recordings, without effect on the held-out "
                                   "error: " +
                                       missing.others + ".") +
         doubtful_part(missing) + what_does_better(report);
}

}  // namespace

const Json& heldout_noise(const Json& fit) {
  return fit[fit.contains("holdout_noise_floor") ? "holdout_noise_floor" : "noise_floor"];
}

std::string headline(const Json& report) {
  const auto [worthless, varying] = unexplained_targets(report);
  if (worthless.empty()) return answer(report);
  const std::string part = worthless_part(worthless);
  if (worthless.size() < varying) return answer(report) + " " + part.substr(0, part.size() - 1);
  return part + "Check its units, signs, axes and clock first (dcnn-check). " + answer(report);
}

}  // namespace dcnn
