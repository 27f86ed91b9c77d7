// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <map>

#include "dcnn/check/check.h"

namespace dcnn::check {
namespace {

std::string sureness(double probability) {
  char text[40];
  const char* word = probability >= kCertain  ? "certain"
                     : probability >= kLikely ? "likely"
                                              : "possible";
  std::snprintf(text, sizeof text, "%-8s %.3f", word, probability);
  return text;
}

Json json_of(const Fault& fault) {
  Json json;
  json["fault"] = fault.id;
  json["probability"] = fault.probability;
  json["channel"] = fault.channel.empty() ? Json() : Json(fault.channel);
  json["interval_s"] =
      fault.interval_s ? Json{fault.interval_s->first, fault.interval_s->second} : Json();
  json["words"] = fault.words;
  json["remedy"] = fault.remedy;
  json["flag"] = fault.flag.empty() ? Json() : Json(fault.flag);
  json["stops"] = fault.stops;
  return json;
}

/// "99.7 %"; never 100 for what is not certain.
std::string percent_text(double probability) {
  char text[16];
  std::snprintf(text, sizeof text, "%.3g %%",
                std::min(100.0 * probability, probability < 1.0 ? 99.9 : 100.0));
  return text;
}

std::string interval_text(const Fault& fault) {
  if (!fault.interval_s) return "";
  char text[64];
  std::snprintf(text, sizeof text, " (t from %.6g to %.6g)", fault.interval_s->first,
                fault.interval_s->second);
  return text;
}

}  // namespace

std::string words_of_number(const std::string& key) {
  const auto cut = key.find('_');
  const std::string stem = key.substr(0, cut),
                    axis = cut == key.npos ? "" : ", " + key.substr(cut + 1);
  static const std::map<std::string, std::string> kWords{{"com", "centre of mass"},
                                                         {"bias", "sensor offset"},
                                                         {"dry", "dry friction"},
                                                         {"viscous", "viscous friction"}};
  const auto known = kWords.find(stem);
  return (known == kWords.end() ? stem : known->second) + axis;
}

std::string verdict(const Report& report) {
  if (report.faults.empty()) return "nothing is wrong that can be told from the data";
  const Fault& first = report.faults.front();
  const std::size_t more = report.faults.size() - 1;
  const std::string others = more == 0   ? ""
                             : more == 1 ? ", and one more fault"
                                         : ", and " + std::to_string(more) + " more faults";
  return first.words + " (probability " + percent_text(first.probability) + ")" + others + "; " +
         first.remedy;
}

Json to_json(const Report& report) {
  Json json;
  json["log"] = report.log;
  json["faults"] = Json::array();
  for (const Fault& fault : report.faults) json["faults"].push_back(json_of(fault));
  json["readings"] = Json::array();
  for (const auto& [words, probability] : report.readings) {
    json["readings"].push_back({{"words", words}, {"probability", probability}});
  }
  json["identifiable"] = Json::object();
  for (const auto& [what, shown] : report.identifiable) json["identifiable"][what] = shown;
  json["notes"] = report.notes;
  return json;
}

std::string to_text(const Report& report) {
  std::string text = report.log + ": ";
  if (report.faults.empty()) text += verdict(report);
  text += "\n";
  for (const Fault& fault : report.faults) {
    text += "  " + sureness(fault.probability) + "  " + fault.id + ": " + fault.words +
            interval_text(fault) + "\n                    mend: " + fault.remedy +
            (fault.flag.empty() ? "" : " (" + fault.flag + ")") + "\n";
  }
  std::string hidden;
  for (const auto& [what, shown] : report.identifiable) {
    if (!shown) hidden += (hidden.empty() ? "" : "; ") + words_of_number(what);
  }
  if (!hidden.empty()) text += "  the motion does not show: " + hidden + "\n";
  for (const std::string& note : report.notes) text += "  " + note + "\n";
  return text;
}

}  // namespace dcnn::check
