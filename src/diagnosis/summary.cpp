// The diagnosis in a sentence and ten lines.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "dcnn/diagnosis/diagnose.h"
#include "diagnosis/plain_findings.h"
#include "diagnosis/words.h"

namespace dcnn {
namespace {

/// By target, of the held-out recordings; of the fitted ones in reports that do not know theirs.
const Json& heldout_noise(const Json& fit) {
  return fit[fit.contains("holdout_noise_floor") ? "holdout_noise_floor" : "noise_floor"];
}

/// Over the targets that have the first one's unit: newtons and newton metres have no mean.
double mean_of(const Json& report, const Json& list) {
  double sum = 0.0, count = 0.0;
  for (std::size_t j = 0; j < list.size(); ++j) {
    if (report["units"][j] != report["units"][0]) continue;
    sum += list[j].get<double>();
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

/// " N (mean of fx, fy, fz)".
std::string of_what(const Json& report) {
  std::string names;
  for (std::size_t j = 0; j < report["units"].size(); ++j) {
    if (report["units"][j] != report["units"][0]) continue;
    names += (names.empty() ? "" : ", ") + report["targets"][j].get<std::string>();
  }
  const bool one = names.find(',') == std::string::npos;
  return " " + report["units"][0].get<std::string>() + (one ? " (" : " (mean of ") + names + ")\n";
}

/// The channel on which the findings gain most.
std::size_t telling_channel(const Json& fit) {
  std::size_t best = 0;
  double most = -1.0;
  for (std::size_t j = 0; j < fit["holdout_rmse_before"].size(); ++j) {
    const double gain = fit["holdout_rmse_before"][j].get<double>() /
                        std::max(1e-12, fit["holdout_rmse_after"][j].get<double>());
    if (gain > most) most = gain, best = j;
  }
  return best;
}

/// "falls from 0.31 to 0.04 N": the held-out error of a channel, in words.
std::string change_of(const Json& report, std::size_t j) {
  const Json& fit = report["fit"];
  const auto unit = report["units"][j].get<std::string>();
  const double before = fit["holdout_rmse_before"][j], after = fit["holdout_rmse_after"][j];
  const std::string a = brief(before), b = brief(after);
  if (a == b) return "stays at " + a + " " + unit;
  return (after < before ? "falls from " : "rises from ") + a + " to " + b + " " + unit;
}

/// The channels that got worse, and the one that is left farthest above its noise, where that is
/// not the one that was named already.
std::string other_channels(const Json& report, std::size_t named) {
  constexpr double kFar = 1.2;
  const Json& fit = report["fit"];
  std::string text;
  double most = kFar;
  std::size_t worst = named;
  for (std::size_t j = 0; j < report["targets"].size(); ++j) {
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
  constexpr double kLeastGain = 0.005;
  const Json& gain = finding["holdout_gain"];
  return !gain.is_null() && std::abs(gain.get<double>()) < kLeastGain;
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

struct Missing {
  std::string words;   ///< findings and what has no name
  std::string others;  ///< findings of which the held-out error does not tell
};

Missing what_is_missing(const Json& report) {
  if (report.contains("arm")) return {capitalised(report["arm"]["words"].get<std::string>()), ""};
  std::string text, others;
  for (const Json& finding : in_lines(report["findings"])) {
    std::string& list = is_without_effect(finding) ? others : text;
    list += (list.empty() ? "" : "; ") + finding["words"].get<std::string>() + against(finding);
  }
  if (!report["unnamed"]["words"].is_null()) {
    text += (text.empty() ? "" : "; and ") + report["unnamed"]["words"].get<std::string>();
  }
  if (!text.empty() || others.empty()) return {capitalised(text), others};
  return {capitalised(others) + ", without effect on the held-out error", ""};
}

/// Targets that vary above their noise, of whose variation the simulator as given explains nothing,
/// and how many do vary.
std::pair<std::vector<std::string>, std::size_t> unexplained_targets(const Json& report) {
  constexpr double kVaries = 1.5;  // times the noise, as a root mean square about the mean
  const Json& fit = report["fit"];
  std::pair<std::vector<std::string>, std::size_t> result;
  const Json explained = fit.value("holdout_explained_before", Json());
  for (std::size_t j = 0; j < explained.size(); ++j) {
    if (explained[j].is_null()) continue;
    const double measured = fit["holdout_rms_measured"][j], noise = heldout_noise(fit)[j];
    if (measured <= kVaries * noise) continue;
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

/// The headline where nothing was held out.
std::string headline_without(const Json& report) {
  const std::string missing = report["verdict"] == "consistent"
                                  ? "Nothing is missing that these recordings could show"
                                  : what_is_missing(report).words;
  return missing +
         ". Nothing was held out (the recordings are too short, or without time), so the error on "
         "new data is not known.";
}

/// What is missing, and what it is worth.
std::string answer(const Json& report) {
  const Json& fit = report["fit"];
  if (fit["holdout_rmse_before"].is_null()) return headline_without(report);
  const std::size_t j = telling_channel(fit);
  const auto unit = report["units"][j].get<std::string>();
  const auto at = [&](const char* key) { return brief(fit[key][j].get<double>()); };
  if (report["verdict"] == "consistent") {
    return "Nothing is missing: the simulator leaves " + at("holdout_rmse_before") + " " + unit +
           " on held-out data, the sensor's noise is " +
           brief(heldout_noise(fit)[j].get<double>()) + " " + unit + ".";
  }
  const Missing missing = what_is_missing(report);
  return missing.words + ". The hold-out error of " + report["targets"][j].get<std::string>() +
         " " + change_of(report, j) + ", the sensor's noise is " +
         brief(heldout_noise(fit)[j].get<double>()) + " " + unit + other_channels(report, j) + "." +
         (missing.others.empty() ? ""
                                 : " In the fitted recordings, without effect on the held-out "
                                   "error: " +
                                       missing.others + ".");
}

}  // namespace

std::string headline(const Json& report) {
  const auto [worthless, varying] = unexplained_targets(report);
  if (worthless.empty()) return answer(report);
  const std::string part = worthless_part(worthless);
  if (worthless.size() < varying) return answer(report) + " " + part.substr(0, part.size() - 1);
  return part + "Check its units, signs, axes and clock first (dcnn-check). " + answer(report);
}

std::string to_text(const Diagnosis& diagnosis) {
  const Json& report = diagnosis.report;
  const Json& fit = report["fit"];
  std::ostringstream out;
  out << headline(report) << "\n\n";
  out << "verdict     " << report["verdict"].get<std::string>() << "\n";
  if (report.contains("zeroed")) {
    out << "zeroed      an offset of its own was estimated for each of " << report["zeroed"].size()
        << " recordings: a constant offset has no name\n";
  }
  for (const Json& finding : in_lines(report["findings"])) {
    out << "found       " << finding["effect"].get<std::string>();
    if (!finding["axis"].is_null()) out << " " << finding["axis"].get<std::string>();
    for (const auto& [name, number] : finding["parameters"].items()) {
      out << "  " << name << " " << brief(number["value"].get<double>());
      if (number["ci95"][0].is_null()) continue;
      out << " [" << brief(number["ci95"][0].get<double>()) << ", "
          << brief(number["ci95"][1].get<double>()) << "]";
    }
    if (!finding["confidence"].is_null()) {
      out << "  confidence " << brief(finding["confidence"].get<double>());
    }
    const Json shared = finding.value("shared_with", Json::object());
    for (const Json& other : finding["alternatives"]) {
      const auto name = other.get<std::string>();
      out << "  or " << name;
      if (shared.contains(name)) out << " " << brief(shared[name].get<double>());
    }
    out << "\n";
  }
  for (const Json& note : report.value("notes", Json::array())) {
    out << "note        " << note.get<std::string>() << "\n";
  }
  for (const Json& stretch : report.value("left_out", Json::array())) {
    out << "left out    " << brief(stretch["interval_s"][0].get<double>()) << " to "
        << brief(stretch["interval_s"][1].get<double>()) << " s of "
        << stretch["recording"].get<std::string>()
        << ": far more is left there than elsewhere, as by a collision or a hand\n";
  }
  if (!report["search"]["complete"].get<bool>()) {
    out << "search      ended at its limit: not every exchange of effects was tried\n";
  }
  if (fit["holdout_rmse_before"].is_null()) {
    out << "hold-out    none, noise " << brief(mean_of(report, fit["noise_floor"]))
        << of_what(report);
    return out.str();
  }
  out << "hold-out    before " << brief(mean_of(report, fit["holdout_rmse_before"]));
  if (!fit["holdout_rmse_parameters"].is_null()) {
    out << ", own numbers refitted " << brief(mean_of(report, fit["holdout_rmse_parameters"]));
  }
  out << ", after " << brief(mean_of(report, fit["holdout_rmse_after"])) << ", noise "
      << brief(mean_of(report, heldout_noise(fit))) << of_what(report);
  if (!report["next_motion"].is_null()) {
    out << "next        to tell " << report["next_motion"]["separates"][0].get<std::string>()
        << " from " << report["next_motion"]["separates"][1].get<std::string>() << ": "
        << report["next_motion"]["words"].get<std::string>() << "\n";
  }
  return out.str();
}

}  // namespace dcnn
