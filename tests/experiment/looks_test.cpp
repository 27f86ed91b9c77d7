// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "dcnn/experiment/report.h"
#include "experiment/reproduction/entries.h"

namespace dcnn {
namespace {

std::set<std::string> found(const std::string& svg, const std::string& pattern) {
  std::set<std::string> all;
  const std::regex expression(pattern);
  for (std::sregex_iterator it(svg.begin(), svg.end(), expression), end; it != end; ++it)
    all.insert((*it)[1].str() + (*it)[2].str());
  return all;
}

TEST(Looks, SixteenSeriesAreSixteenMarkersAndLines) {
  Chart chart;
  chart.legend = false;
  const Series one{"", {0, 1}, {1, 2}, {}, Series::Style::kLineAndMarkers};
  chart.series.assign(16, one);
  const std::string svg = to_svg(chart);
  EXPECT_EQ(found(svg, R"re(<path d="([^"]*)"[^>]* fill="([^"]*)")re").size(), 16U);
  EXPECT_EQ(found(svg, R"re(<polyline[^>]*round" ([^/]*)()/>)re").size(), 16U);
}

/// Figures show the models of the paper beside those of either other group.
TEST(Looks, NoTwoModelsOfAFigureLookAlike) {
  using Group = Entry::Group;
  for (const Group other : {Group::kReading, Group::kOwn}) {
    std::set<int> looks;
    std::size_t models = 0;
    for (const Entry& entry : choose_entries({}, "paper")) {
      if (entry.name == kNoIdentification) continue;  // a line among markers
      if (entry.group != Group::kPaper && entry.group != other) continue;
      looks.insert(entry.look);
      ++models;
    }
    EXPECT_EQ(looks.size(), models);
  }
}

}  // namespace
}  // namespace dcnn
