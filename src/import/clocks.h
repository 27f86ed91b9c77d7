// SPDX-License-Identifier: Apache-2.0
// Times of a stream's rows.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "dcnn/import/recipe.h"

namespace dcnn {

/// Where a stream's times come from, as far as names and sizes tell.
ClockRule propose_clock(const LogStream& stream, const ImportWishes& wishes,
                        std::vector<std::string>* guesses);

/// The clock of a stream that gives nothing else, for as many rows of another that has none: one of
/// `clocks`, which are those of the streams in use.
std::optional<ClockRule> lone_clock(const ForeignLog& log, const std::vector<ClockRule>& clocks,
                                    const ImportWishes& wishes, std::vector<std::string>* guesses);

/// The clock of a stream that names none: its first column where that grows evenly, else the rate
/// of its rows, to three digits, where logged rates tell it.
void propose_unnamed(const LogStream& stream, ClockRule* rule, std::vector<std::string>* guesses);

/// Where rows without a clock are a motion, not a list of poses: a guess that asks for one.
void ask_for_clock(const ForeignLog& log, Proposal* proposal);
/// Where the stamps of two streams have no time in common, and their times of receipt have: a
/// question.
void ask_for_stamps(const ForeignLog& log, const ImportWishes& wishes, Proposal* proposal);

/// s; empty for kind none. Rows without a time are NaN.
std::vector<double> clock_times(const LogStream& stream, const ClockRule& rule,
                                const std::string& file);

/// The first and the last time, s; zeros where there is none.
std::pair<double, double> ends_of(const std::vector<double>& times);

/// Figures of a clock for the printed table.
struct ClockFigures {
  double begin = 0.0, end = 0.0, step = 0.0;  ///< s; step: the median
  Index gaps = 0, repeats = 0, backward = 0;  ///< steps above 5 medians, of zero, negative
  double off = 0.0;                           ///< part of the steps off by more than 20 %
};
ClockFigures clock_figures(const std::vector<double>& times);

}  // namespace dcnn
