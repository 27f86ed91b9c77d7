// The error on recordings, or blocks of time, that nothing was decided on.
#pragma once

#include "dcnn/diagnosis/diagnose.h"
#include "diagnosis/search.h"

namespace dcnn {

/// Every fifth block of 5 s, with guards of 0.5 s on both sides.
std::vector<Span> held_out_blocks(const Case& study, bool with_guards);

class HoldOut {
 public:
  /// Recordings of their own, or (`recordings` without logs) the blocks of the fitted ones.
  HoldOut(const Case& fitted, const Case& recordings);

  /// RMSE by channel of the case's simulator with these members.
  std::vector<double> rmse(const std::vector<Member>& members) const;
  Signals prediction(const std::vector<Member>& members) const;
  std::vector<HeldOut> records(const std::vector<Member>& members) const;

 private:
  Case study_;
  std::vector<std::vector<char>> held_;  // per recording and row
};

}  // namespace dcnn
