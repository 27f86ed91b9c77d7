// SPDX-License-Identifier: Apache-2.0
// Table I of the paper: mean time per call and total, in seconds (MATLAB 2018b, i7 2.80 GHz).
#pragma once

#include <string>

namespace dcnn {

struct PaperTime {
  const char* entry;
  int length;
  double mean_s, std_s, total_s, total_std_s;
};

inline constexpr PaperTime kPaperTimes[] = {
    {"cf", 1, 0.0003, 0.00001, 12.19, 0.33},      {"cf", 5, 0.0004, 0.00002, 3.01, 0.20},
    {"cf", 10, 0.0003, 0.00001, 1.07, 0.09},      {"ffnn-s", 1, 0.0044, 0.00006, 165.46, 2.01},
    {"ffnn-s", 5, 0.0046, 0.00020, 33.21, 1.70},  {"ffnn-s", 10, 0.0045, 0.00009, 16.29, 0.36},
    {"cfnn-s", 1, 0.0060, 0.00009, 198.44, 2.92}, {"cfnn-s", 5, 0.0059, 0.00025, 40.71, 1.56},
    {"cfnn-s", 10, 0.0060, 0.00009, 19.49, 0.30}, {"ffnn-m", 1, 0.0067, 0.00008, 215.05, 2.64},
    {"ffnn-m", 5, 0.0068, 0.00027, 43.88, 1.70},  {"ffnn-m", 10, 0.0067, 0.00011, 21.54, 0.36},
    {"cfnn-m", 1, 0.0074, 0.00010, 236.20, 3.36}, {"cfnn-m", 5, 0.0076, 0.00031, 48.66, 1.97},
    {"cfnn-m", 10, 0.0075, 0.00015, 23.93, 0.48}, {"lstm", 1, 0.0112, 0.00038, 357.44, 12.3},
    {"lstm", 5, 0.0117, 0.00061, 74.97, 3.94},    {"lstm", 10, 0.0117, 0.00054, 37.64, 1.75},
    {"dcnn", 1, 0.0031, 0.00002, 100.75, 0.49},   {"dcnn", 5, 0.0056, 0.00016, 35.68, 1.01},
    {"dcnn", 10, 0.0054, 0.00008, 17.34, 0.24},
};

/// The paper's row, null where it has none.
inline const PaperTime* paper_time(const std::string& entry, int length) {
  for (const PaperTime& row : kPaperTimes) {
    if (entry == row.entry && length == row.length) return &row;
  }
  return nullptr;
}

}  // namespace dcnn
