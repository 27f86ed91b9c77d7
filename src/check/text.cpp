#include <cstdio>

#include "dcnn/check/check.h"

namespace dcnn::check {
namespace {

std::string sureness(double probability) {
  char text[40];
  const char* word = probability >= kCertain ? "certain" : probability >= kLikely ? "likely" : "possible";
  std::snprintf(text, sizeof text, "%-8s %.3f", word, probability);
  return text;
}

Json json_of(const Fault& fault) {
  Json json;
  json["fault"] = fault.id;
  json["probability"] = fault.probability;
  json["channel"] = fault.channel.empty() ? Json() : Json(fault.channel);
  json["interval_s"] = fault.interval_s ? Json{fault.interval_s->first, fault.interval_s->second} : Json();
  json["words"] = fault.words;
  json["remedy"] = fault.remedy;
  json["flag"] = fault.flag.empty() ? Json() : Json(fault.flag);
  json["stops"] = fault.stops;
  return json;
}

std::string interval_text(const Fault& fault) {
  if (!fault.interval_s) return "";
  char text[64];
  std::snprintf(text, sizeof text, " (t from %.6g to %.6g)", fault.interval_s->first, fault.interval_s->second);
  return text;
}

}  // namespace

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
  if (report.faults.empty()) text += "nothing is wrong that can be told from the data";
  text += "\n";
  for (const Fault& fault : report.faults) {
    text += "  " + sureness(fault.probability) + "  " + fault.id + ": " + fault.words + interval_text(fault) +
            "\n                    mend: " + fault.remedy + (fault.flag.empty() ? "" : " (" + fault.flag + ")") + "\n";
  }
  std::string hidden;
  for (const auto& [what, shown] : report.identifiable) {
    if (!shown) hidden += (hidden.empty() ? "" : ", ") + what;
  }
  if (!hidden.empty()) text += "  the motion does not show: " + hidden + "\n";
  for (const std::string& note : report.notes) text += "  " + note + "\n";
  return text;
}

}  // namespace dcnn::check
