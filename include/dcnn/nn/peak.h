// What the machine could do at most: the measure of every kernel.
#pragma once

namespace dcnn {

/// Measured multiply-adds per second of all threads together, in the widest vectors of this
/// machine: the best of so many stretches of some milliseconds.
double peak_multiply_adds(int repetitions = 20);

}  // namespace dcnn
