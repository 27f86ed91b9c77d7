// SPDX-License-Identifier: Apache-2.0
// Long work that is given up where that is wished.
#pragma once

#include <exception>
#include <functional>

namespace dcnn {

/// Thrown where work is given up because that was wished: no fault of anything.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

/// While it lives, for_each_piece() throws Interrupted instead of beginning once `wish` is true:
/// for long work that has no state to save. An empty wish is none. One at a time.
class Interruptible {
 public:
  explicit Interruptible(std::function<bool()> wish);
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  std::function<bool()> wish_;
};

}  // namespace dcnn
