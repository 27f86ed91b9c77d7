// SPDX-License-Identifier: Apache-2.0
// The comparison as figures of the page.
#include <algorithm>

#include "dcnn/experiment/peers.h"
#include "experiment/peers/tables.h"

namespace dcnn {
namespace {

Series& series_of(Chart& chart, const std::string& label, Series::Style style) {
  const auto found = std::ranges::find(chart.series, label, &Series::label);
  if (found != chart.series.end()) return *found;
  chart.series.push_back({label, {}, {}, {}, style});
  return chart.series.back();
}

/// Calls `point(library, seconds of a call)` for every library of a row, ours first.
template <class Point>
void for_each_library(const PeersRow& row, const Point& point) {
  point("dcnn", row.ours.median);
  for (const PeerResult& peer : row.peers) point(peer.peer, peer.call.median);
}

std::vector<std::string> networks(const Peers& peers) {
  std::vector<std::string> names;
  for (const PeersRow& row : peers.rows) {
    if (std::ranges::find(names, row.network) == names.end()) names.push_back(row.network);
  }
  return names;
}

Chart latency_chart(const Peers& peers) {
  Chart chart;
  chart.title = "time of a call";
  chart.y_label = "one sample, one thread [µs]";
  chart.log_y = true;
  chart.side_by_side = true;
  for (const PeersRow& row : peers.rows) {
    if (row.batch != 1) continue;
    const auto place = static_cast<double>(chart.categories.size());
    chart.categories.push_back(row.network);
    for_each_library(row, [&](const std::string& library, double seconds) {
      Series& series = series_of(chart, library, Series::Style::kMarkers);
      series.x.push_back(place);
      series.y.push_back(1e6 * seconds);
    });
  }
  return chart;
}

/// Categories, since batches go over four decades and the axis of x is linear.
std::vector<Index> batches(const Peers& peers, const std::string& network, int threads) {
  std::vector<Index> list;
  for (const PeersRow& row : peers.rows) {
    if (row.network == network && row.threads == threads) list.push_back(row.batch);
  }
  return list;
}

Chart batch_chart(const Peers& peers, const std::string& network) {
  Chart chart;
  chart.title = network;
  chart.x_label = "samples per call, one thread";
  chart.y_label = "time per sample [µs]";
  chart.log_y = true;
  chart.width = 420;
  for (const Index batch : batches(peers, network, 1)) {
    chart.categories.push_back(std::to_string(batch));
  }
  double place = 0.0;
  for (const PeersRow& row : peers.rows) {
    if (row.network != network || row.threads != 1) continue;
    for_each_library(row, [&](const std::string& library, double seconds) {
      Series& series = series_of(chart, library, Series::Style::kLineAndMarkers);
      series.x.push_back(place);
      series.y.push_back(1e6 * seconds / static_cast<double>(row.batch));
    });
    place += 1.0;
  }
  return chart;
}

/// How many times faster all threads are than one.
Chart thread_chart(const Peers& peers, const std::string& network) {
  Chart chart;
  chart.title = network;
  chart.x_label = "samples per call";
  chart.width = 420;
  for (const PeersRow& row : peers.rows) {
    if (row.network != network || row.threads == 1) continue;
    const auto one = std::ranges::find_if(peers.rows, [&](const PeersRow& other) {
      return other.network == network && other.batch == row.batch && other.threads == 1;
    });
    if (one == peers.rows.end()) continue;
    chart.y_label = "times faster with " + std::to_string(row.threads) + " threads";
    const auto place = static_cast<double>(chart.categories.size());
    chart.categories.push_back(std::to_string(row.batch));
    for_each_library(row, [&](const std::string& library, double seconds) {
      for_each_library(*one, [&](const std::string& same, double alone) {
        if (same != library) return;
        Series& series = series_of(chart, library, Series::Style::kLineAndMarkers);
        series.x.push_back(place);
        series.y.push_back(alone / seconds);
      });
    });
  }
  return chart;
}

/// Ours is 0; every library looks alike in all charts.
int look_of(const Peers& peers, const std::string& library) {
  int look = 0;
  for (const Peer& peer : peers.peers) {
    if (!peer.missing.empty()) continue;
    ++look;
    if (peer.name == library) return look;
  }
  return 0;
}

Chart epoch_chart(const Peers& peers) {
  Chart chart;
  chart.title = "training";
  chart.y_label = "time of an epoch [s]";
  chart.log_y = true;
  chart.side_by_side = true;
  for (const EpochRow& row : peers.epochs) {
    const auto place = static_cast<double>(chart.categories.size());
    chart.categories.push_back(row.network);
    for (const auto& [library, seconds] :
         {std::pair{std::string("dcnn"), row.ours}, std::pair{row.peer, row.theirs}}) {
      Series& series = series_of(chart, library, Series::Style::kMarkers);
      series.look = look_of(peers, library);
      series.x.push_back(place);
      series.y.push_back(seconds);
    }
  }
  return chart;
}

void add_panels(HtmlReport& page, const Peers& peers,
                Chart (*make)(const Peers&, const std::string&), const std::string& caption) {
  std::vector<Chart> charts;
  for (const std::string& network : networks(peers)) {
    Chart chart = make(peers, network);
    if (chart.categories.size() > 1) charts.push_back(std::move(chart));
  }
  if (!charts.empty()) page.panels(std::move(charts), caption);
}

/// Whose row it is and those columns: all of them are wider than the page.
void add_columns(HtmlReport& page, const PeerTable& table, std::vector<std::string> names) {
  names.insert(names.begin(), {"network", "batch", "threads", "library"});
  std::vector<std::vector<std::string>> rows(table.rows.size());
  for (const std::string& name : names) {
    const auto column = std::ranges::find(table.header, name) - table.header.begin();
    for (std::size_t k = 0; k < rows.size(); ++k) {
      rows[k].push_back(table.rows[k][static_cast<std::size_t>(column)]);
    }
  }
  page.table(names, rows);
}

}  // namespace

void add_to(HtmlReport& page, const Peers& peers) {
  page.heading("Beside other libraries");
  std::string libraries;
  for (const std::string& line : peer_lines(peers)) {
    libraries += (libraries.empty() ? "" : "; ") + line;
  }
  page.paragraph(libraries + ".");
  const Chart latency = latency_chart(peers);
  if (!latency.categories.empty()) {
    page.chart(latency,
               "time of one prediction, calls of every library in turns, through its host where it "
               "has one");
  }
  add_panels(page, peers, batch_chart, "time per sample over the samples of a call");
  add_panels(page, peers, thread_chart, "gain by threads over the samples of a call");
  if (!peers.epochs.empty()) page.chart(epoch_chart(peers), "time of a training epoch");
  if (!peers.rows.empty()) {
    const PeerTable calls = call_table(peers);
    add_columns(page, calls, {"call [us]", "ratio", "overhead [us]", "net", "net of least"});
    add_columns(page, calls, {"p50 [us]", "p99 [us]", "max [us]", "p99/p50", "of a loop"});
    add_columns(page, calls, {"G products/s", "of peak", "difference"});
    page.paragraph(kCallNote);
  }
  if (!peers.epochs.empty()) {
    const PeerTable epochs = epoch_table(peers);
    page.table(epochs.header, epochs.rows);
    page.paragraph(kEpochNote);
  }
  for (const auto& note : peers.notes) page.paragraph(note);
}

}  // namespace dcnn
