// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/teleop_report.h"

#include <map>

#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/data/csv.h"
#include "dcnn/experiment/report.h"
#include "experiment/markup.h"
#include "experiment/report_words.h"
#include "experiment/series.h"

namespace dcnn {
namespace {

Chart time_chart(const std::string& title, const std::string& y_label) {
  Chart chart;
  chart.title = title;
  chart.x_label = "time [s]";
  chart.y_label = y_label;
  chart.height = 240;
  return chart;
}

/// Rows of Fig. 6: x, y, z of master and slave, the error's norm, and the forces.
std::vector<Chart> figure_six(const TeleopResult& result, const TeleopConfig& config) {
  const TeleopTrace& trace = result.trace;
  const auto t = list_of(trace.t);
  const std::string name = name_of_variant(result.name);
  std::vector<Chart> rows;
  const Eigen::MatrixXd master = 1e3 * config.position_scale * trace.master;
  for (Index k = 0; k < 3; ++k) {
    Chart chart = time_chart(name + ": " + "xyz"[k], std::string(1, "xyz"[k]) + " [mm]");
    chart.series.push_back({"master, scaled", t, list_of(master.col(k)), {}});
    chart.series.push_back({"slave", t, list_of(1e3 * trace.slave.col(k)), {}});
    rows.push_back(chart);
  }
  Chart error = time_chart(name + ": error norm", "error [mm]");
  const Eigen::VectorXd norm =
      1e3 * (trace.slave - config.position_scale * trace.master).rowwise().norm();
  error.series.push_back({"error", t, list_of(norm), {}});
  rows.push_back(error);
  Chart force = time_chart(name + ": force along the wall's normal", "force [N]");
  force.series.push_back({"true contact", t, list_of(trace.contact.col(2)), {}});
  force.series.push_back({"on the hand", t, list_of(trace.felt.col(2)), {}});
  rows.push_back(force);
  return rows;
}

std::string words_of_variant(const std::string& name) {
  static const std::map<std::string, std::string> kWords{
      {"ideal", "where the tool's own force is known exactly"},
      {"none", "without force feedback"},
      {"ns", "with the sensor's raw force"},
      {"live", "in the live run"}};
  const auto known = kWords.find(name);
  return known == kWords.end() ? "with " + name : known->second;
}

/// The contact of all variants side by side: where the slave went, and what the hand felt.
std::vector<Chart> comparison(const std::vector<TeleopResult>& results) {
  Chart z = time_chart("Slave, z", "z [mm]");
  Chart felt = time_chart("Force on the hand, z", "force [N]");
  for (const TeleopResult& result : results) {
    const auto t = list_of(result.trace.t);
    z.series.push_back(
        {name_of_variant(result.name), t, list_of(1e3 * result.trace.slave.col(2)), {}});
    felt.series.push_back({name_of_variant(result.name), t, list_of(result.trace.felt.col(2)), {}});
  }
  return {z, felt};
}

std::string cell(const Json& value, double scale) {
  return value.is_number() ? significant(scale * value.get<double>(), 3) : "–";
}

void add_table(const std::vector<TeleopResult>& results, HtmlReport& page) {
  std::vector<std::vector<std::string>> rows;
  for (const TeleopResult& r : results) {
    const Json& j = r.row;
    const Json& contact = j["contact_interval_s"];
    const std::string interval =
        contact.is_null() ? "no contact" : fixed(contact[0], 1) + "-" + fixed(contact[1], 1);
    rows.push_back(
        {name_of_variant(r.name), interval, cell(j["force_max_n"], 1),
         cell(j["free_error_rms_m"], 1e3) + " / " + cell(j["free_error_max_m"], 1e3),
         cell(j["contact_error_rms_m"], 1e3) + " / " + cell(j["contact_error_max_m"], 1e3),
         cell(j["handle_force_free_rms_n"], 1), cell(j["master_drift_m"], 1e3),
         j["stable"].get<bool>() ? "yes" : "no", cell(j["energy_min_j"], 1e3)});
  }
  page.table({"variant", "contact [s]", "F max [N]", "free error z rms / max [mm]",
              "contact error z rms / max [mm]", "handle force, free, rms [N]", "master drift [mm]",
              "stable", "least energy [mJ]"},
             rows);
}

Table signals(const TeleopTrace& trace) {
  Table table;
  table.columns = {"t"};
  table.values.resize(trace.t.size(), 19);
  table.values.col(0) = trace.t;
  Index column = 1;
  const auto add = [&](const std::string& name, const Eigen::MatrixXd& block) {
    for (Index k = 0; k < 3; ++k) {
      table.columns.push_back(name + "_" + "xyz"[k]);
      table.values.col(column++) = block.col(k);
    }
  };
  add("intended", trace.intended);
  add("master", trace.master);
  add("slave", trace.slave);
  add("contact", trace.contact);
  add("estimated", trace.estimated);
  add("felt", trace.felt);
  return table;
}

/// What the compensation does to the force that the hand feels in free motion, in one sentence.
std::string teleop_answer(const std::vector<TeleopResult>& results) {
  std::string text;
  for (const TeleopResult& r : results) {
    const Json& felt = r.row["handle_force_free_rms_n"];
    if (!felt.is_number()) continue;
    text += (text.empty() ? "" : ", ") + with_unit(felt.get<double>(), "N") + " " +
            words_of_variant(r.name);
  }
  return "In free motion, where there is nothing to feel, the hand feels " + text + " (rms).";
}

}  // namespace

std::string name_of_variant(const std::string& name) {
  static const std::map<std::string, std::string> kNames{
      {"ideal", "tool known"}, {"none", "no feedback"}, {"ns", "raw force"}, {"live", "live run"}};
  const auto known = kNames.find(name);
  return known == kNames.end() ? name : known->second;
}

std::string teleop_line(const Json& row) {
  const Json& contact = row["contact_interval_s"];
  const std::string text = contact.is_null() ? "no contact"
                                             : "contact from " + fixed(contact[0], 1) + " to " +
                                                   fixed(contact[1], 1) + " s, at most " +
                                                   cell(row["force_max_n"], 1) + " N";
  return name_of_variant(row["name"].get<std::string>()) + ": " + text + "; the master drifts by " +
         cell(row["master_drift_m"], 1e3) + " mm";
}

void write_teleop(const std::filesystem::path& folder, const TeleopConfig& config,
                  const std::vector<TeleopResult>& results, std::uint64_t seed) {
  FileSet files(folder);
  HtmlReport page("Bilateral teleoperation");
  page.paragraph(teleop_answer(results));
  const auto compared = comparison(results);
  page.chart(
      compared[1],
      "'tool known' subtracts the tool's own force exactly, 'no feedback' sends no force back, "
      "'raw force' sends what the sensor reads.");
  add_table(results, page);
  page.paragraph("A simulated demonstration (seed " + std::to_string(seed) +
                 "); every mass, stiffness and delay is a free assumption and stands in the "
                 "configuration. The hand pushes 15 mm into a wall at about 70 to 75 s.");
  page.paragraph(
      "Errors are slave minus scaled master without correction of the delay. The least "
      "energy is what link, slave and wall took from the hand: below zero they gave "
      "back more than they had been given.");
  Json variants = Json::array();
  page.heading("The slave in all variants");
  page.chart(compared[0], "");
  for (std::size_t k = 0; k < compared.size(); ++k) {
    write_file(folder / ("comparison_" + std::to_string(k) + ".svg"), to_svg(compared[k]));
  }
  for (const TeleopResult& result : results) {
    variants.push_back(result.row);
    page.heading("Fig. 6, " + words_of_variant(result.name));
    const auto rows = figure_six(result, config);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      page.chart(rows[k], "");
      write_file(folder / (result.name + "_" + std::to_string(k) + ".svg"), to_svg(rows[k]));
    }
    write_csv(folder / (result.name + ".csv"), signals(result.trace));
  }
  const std::string frames = frames_svg(config);
  page.heading("Frames");
  page.drawing(frames,
               "Fig. 1 at the places of the configuration. The camera is carried and not used; the "
               "hand moves along the slave's axes.");
  write_file(folder / "frames.svg", frames);
  write_file(folder / "report.html", page.html());
  write_file(folder / "teleop.json", Json{{"variants", variants}}.dump(2) + "\n");
  files.commit();
}

}  // namespace dcnn
