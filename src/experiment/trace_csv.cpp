// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/csv.h"
#include "dcnn/experiment/evaluate.h"

namespace dcnn {
namespace {

constexpr Eigen::Index kMaxTraceRows = 4096;

}  // namespace

void write_trace(const std::filesystem::path& file, const Evaluation& evaluation) {
  if (evaluation.traces.empty()) return write_csv(file, Table{});
  const Trace& trace = evaluation.traces.front();
  const Eigen::Index stride = (trace.t.size() + kMaxTraceRows - 1) / kMaxTraceRows,
                     rows = trace.t.size() / stride, targets = trace.measured.cols();
  Table table;
  table.columns = {"t"};
  for (const auto& name : evaluation.targets.names) table.columns.push_back(name);
  for (const auto& name : evaluation.targets.names) table.columns.push_back(name + "_hat");
  table.values.resize(rows, 1 + 2 * targets);
  for (Eigen::Index i = 0; i < rows; ++i) {
    table.values(i, 0) = trace.t[i * stride];
    table.values.row(i).segment(1, targets) = trace.measured.row(i * stride);
    table.values.row(i).tail(targets) = trace.predicted.row(i * stride);
  }
  write_csv(file, table);
}

}  // namespace dcnn
