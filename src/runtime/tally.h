// SPDX-License-Identifier: Apache-2.0
// What a loop has seen, in fixed memory.
#pragma once

#include <ctime>

#include "dcnn/runtime/serve.h"

namespace dcnn {

/// CPU time of this thread, s.
inline double thread_seconds() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Tally {
  std::array<std::uint64_t, 6> states{};
  std::array<std::uint64_t, 14> reasons{};
  std::uint64_t contacts = 0, misses = 0, overruns = 0;
  CycleTimes times;

  void add(const OnlineResult& result) noexcept {
    ++states[static_cast<std::size_t>(result.state)];
    ++reasons[static_cast<std::size_t>(result.reason)];
    contacts += result.contact;
  }
  Json to_json() const {
    Json json = {{"states", Json::object()}, {"reasons", Json::object()}};
    for (std::size_t i = 0; i < states.size(); ++i) {
      json["states"][name_of(static_cast<RunState>(i))] = states[i];
    }
    for (std::size_t i = 0; i < reasons.size(); ++i) {
      if (reasons[i] > 0) json["reasons"][name_of(static_cast<Reason>(i))] = reasons[i];
    }
    json["contact_cycles"] = contacts;
    json["missed_cycles"] = misses;
    json["overruns"] = overruns;
    json["cpu"] = times.to_json();
    return json;
  }
};

}  // namespace dcnn
