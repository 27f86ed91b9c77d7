// SPDX-License-Identifier: Apache-2.0
// What the machine could do at most: the measure of every kernel.
#pragma once

namespace dcnn {

/// Measured multiply-adds per second of all threads together, in the widest vectors of this
/// machine: the best of so many stretches of some milliseconds.
double peak_multiply_adds(int repetitions = 20);

/// Measured bytes per second that one thread reads of so many kilobytes again and again: of the
/// cache that just holds them. The best of so many stretches.
double peak_read_bytes(int kilobytes, int repetitions = 20);

}  // namespace dcnn
