// SPDX-License-Identifier: Apache-2.0
// Numbers beyond which no recording and no model file goes: what a file says may not decide how much
// memory or time is taken.
#pragma once

namespace dcnn {

constexpr double kFastestStep = 1e-6;    // s between samples
constexpr double kSlowestStep = 1000.0;  // s
constexpr int kLongestWindow = 1 << 17;  // samples of a derivative's window: 100 s at 1.3 kHz
constexpr double kMostMeasured = 1e9;    // of a wrist, in SI units: no sensor reads a giganewton
constexpr double kMostOfAxis = 1e12;     // of another machine, whose units are its own

}  // namespace dcnn
