// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/check_report.h"

#include <algorithm>

#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/experiment/report.h"
#include "experiment/markup.h"
#include "experiment/series.h"

namespace dcnn {
namespace {

std::vector<std::string> fault_row(const check::Fault& fault) {
  const std::string remedy = fault.remedy + (fault.flag.empty() ? "" : " (" + fault.flag + ")");
  const std::string where = fault.interval_s ? significant(fault.interval_s->first, 6) + " to " +
                                                   significant(fault.interval_s->second, 6)
                                             : "";
  std::string name = fault.id;  // in words, as --accept writes it but for the signs between
  std::replace(name.begin(), name.end(), '_', ' ');
  return {name, significant(fault.probability, 4), fault.words, where, remedy};
}

void add_faults(const check::Report& report, HtmlReport& page) {
  if (report.faults.empty()) return;
  std::vector<std::vector<std::string>> rows;
  for (const check::Fault& fault : report.faults) rows.push_back(fault_row(fault));
  page.table({"fault", "probability", "what is wrong", "t", "what mends it"}, rows);
}

std::string caption_of(const check::Report& report) {
  const bool tool = report.model == "rigid tool";
  return std::string(tool ? "The force" : "The torques") +
         ", in the likeliest reading of the log, beside the best fit of " +
         (tool ? "a rigid tool (mass, centre of mass, offset)"
               : "the arm described (links within 30 %, a body at the flange, friction, rotors)") +
         ", both smoothed over 0.12 s.";
}

void add_forces(const check::Report& report, HtmlReport& page) {
  for (std::size_t k = 0; k < report.measured.size(); ++k) {
    const check::Curve& logged = report.measured[k];
    const check::Curve& rigid = report.rigid[k];
    Chart chart{logged.label, "time [s]", logged.quantity, {}, {}, false, 720, 220};
    chart.series.push_back({"as logged", list_of(logged.t), list_of(logged.values), {}});
    chart.series.push_back({report.model, list_of(rigid.t), list_of(rigid.values), {}});
    const bool last = k + 1 == report.measured.size();
    page.chart(chart, last ? caption_of(report) : "");
  }
}

void add_readings(const check::Report& report, HtmlReport& page) {
  std::vector<std::vector<std::string>> rows;
  for (const check::ReadingWeight& reading : report.readings) {
    rows.push_back({reading.words, significant(reading.probability, 3)});
  }
  page.paragraph("Ways to read the log, by their posterior probability:");
  page.table({"reading", "probability"}, rows);
}

void add_identifiable(const check::Report& report, HtmlReport& page) {
  if (report.identifiable.empty()) return;
  std::vector<std::vector<std::string>> rows;
  for (const auto& [what, shown] : report.identifiable)
    rows.push_back({check::words_of_number(what), shown ? "yes" : "no"});
  page.paragraph("What the motion shows:");
  page.table({"number", "identifiable"}, rows);
}

}  // namespace

Json check_json(const std::vector<check::Report>& reports) {
  Json json;
  json["faults"] = Json::array();
  json["identifiable"] = Json::object();
  json["logs"] = Json::array();
  for (const check::Report& report : reports) {
    Json one = check::to_json(report);
    for (Json fault : one["faults"]) {
      fault["log"] = report.log;
      json["faults"].push_back(fault);
    }
    for (const auto& [what, shown] : report.identifiable) {
      json["identifiable"][what] = shown || json["identifiable"].value(what, false);
    }
    json["logs"].push_back(std::move(one));
  }
  return json;
}

std::string check_html(const std::vector<check::Report>& reports) {
  HtmlReport page("Check of recordings");
  for (const check::Report& report : reports) {
    page.paragraph(report.log + ": " + check::verdict(report) + ".");
  }
  const bool one = reports.size() == 1;  // then picture and table stand beside the answer
  for (const check::Report& report : reports) {
    if (!one) page.heading(report.log);
    add_forces(report, page);
    add_faults(report, page);
    if (one) page.heading("What the recording shows");
    add_readings(report, page);
    add_identifiable(report, page);
    for (const std::string& note : report.notes) page.paragraph(note);
  }
  return page.html();
}

void write_check(const std::filesystem::path& folder, const std::vector<check::Report>& reports) {
  FileSet files(folder);
  write_file(folder / "check.json", check_json(reports).dump(2) + "\n");
  write_file(folder / "check.html", check_html(reports));
  files.commit();
}

}  // namespace dcnn
