// SPDX-License-Identifier: Apache-2.0
// The processes that mpirun started, as ranks of one training.
#pragma once

#include <memory>
#include <string>

namespace dcnn {

class Ranks;

/// Joins them where there are several; else nothing. Those behind the first are silent, but for the
/// reason of a failure that is theirs alone.
class JoinedRanks {
 public:
  explicit JoinedRanks(std::string program);
  ~JoinedRanks();
  JoinedRanks(const JoinedRanks&) = delete;
  JoinedRanks& operator=(const JoinedRanks&) = delete;

  /// Seconds of computing and of exchanging, on stderr.
  void print_times() const;
  /// The exit code, once all are done; a failure ends all.
  int leave(int code);

 private:
  void fall_silent();

  std::string program_;
  std::unique_ptr<Ranks> ranks_;
  double begin_ = 0.0;
  int loud_ = -1;  ///< standard error as it was
};

}  // namespace dcnn
