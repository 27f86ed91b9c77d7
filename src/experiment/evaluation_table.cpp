// SPDX-License-Identifier: Apache-2.0
#include "experiment/evaluation_table.h"

#include <optional>

#include "experiment/markup.h"

namespace dcnn {

std::string with_spread(const Spread& s, int runs, int decimals) {
  return fixed(s.mean, decimals) + (runs > 1 ? " ± " + fixed(s.deviation, decimals) : "");
}

std::vector<int> column_decimals(const Evaluation& evaluation) {
  std::vector<std::vector<double>> columns(evaluation.targets.names.size() + 1);
  const auto add = [&](const std::vector<double>& rmse, const std::optional<double>& overall) {
    for (std::size_t j = 0; j < rmse.size(); ++j) columns[j].push_back(rmse[j]);
    if (overall) columns.back().push_back(*overall);
  };
  for (const auto& s : evaluation.summary) {
    std::vector<double> means;
    for (const Spread& axis : s.rmse) means.push_back(axis.mean);
    add(means, s.overall ? std::optional(s.overall->mean) : std::nullopt);
  }
  for (const auto& rigid : evaluation.references.rigid) add(rigid.score.rmse, rigid.score.overall);
  add(evaluation.unidentified.rmse, evaluation.unidentified.overall);
  add(evaluation.references.noise, std::nullopt);
  std::vector<int> decimals;
  for (const auto& column : columns) decimals.push_back(common_decimals(column, 3));
  return decimals;
}

}  // namespace dcnn
