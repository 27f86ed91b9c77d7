// SPDX-License-Identifier: Apache-2.0
// What coordinates are called: of a tool, and of the axis of a machine, which passes the chain of a
// tool (axis_machine.h).
#include "dcnn/physics/law.h"

namespace dcnn::law {
namespace {

struct AxisTerm {
  const char *of_tool, *name, *unit, *words;  // units: P of the position, U of the effort
};
constexpr AxisTerm kAxisTerms[] = {
    {"alpha", "q", "P", "the position"},
    {"v_base_x", "dq", "P/s", "the velocity"},
    {"speed", "speed", "P/s", "the speed"},
    {"load", "load", "U", "the size of the predicted effort"},
    {"t", "t", "s", "the time"},
};

const AxisTerm* axis_term(const std::string& of_tool) {
  for (const AxisTerm& term : kAxisTerms) {
    if (of_tool == term.of_tool) return &term;
  }
  return nullptr;
}

}  // namespace

bool is_of_axes(std::size_t coordinate) {
  return is_signal(coordinate) || axis_term(coordinates()[coordinate].name) != nullptr;
}

const Terms& tool_terms() {
  static const Terms terms = with_signals({coordinates(), ""}, {});
  return terms;
}

Terms with_signals(Terms terms, const std::vector<std::string>& columns) {
  for (std::size_t k = 0; k < kMostSignals; ++k) {
    Coordinate& q = terms.coordinates[signal_coordinate(k)];
    q.name = k < columns.size() ? columns[k] : "";
    q.words = "the logged " + q.name;
  }
  return terms;
}

Terms axis_terms(const std::string& axis, const std::string& effort,
                 const std::string& position_unit, double resisting) {
  Terms terms{coordinates(), axis, effort, resisting};
  const std::string position = position_unit.empty() ? "1" : position_unit;
  for (Coordinate& q : terms.coordinates) {
    const AxisTerm* const term = axis_term(q.name);
    q.name = term == nullptr ? "" : term->name;
    if (term == nullptr) continue;
    q.frame = "";
    q.words = term->words;
    q.unit = term->unit;
    if (q.unit.front() == 'P') q.unit.replace(0, 1, position);
    if (q.unit == "U") q.unit = effort;
  }
  return terms;
}

}  // namespace dcnn::law
