// SPDX-License-Identifier: Apache-2.0
// The model of names alone, to which a search of laws may come back.
#pragma once

#include "diagnosis/holdout.h"
#include "diagnosis/laws.h"

namespace dcnn {

/// The names of a search as they are when it is made.
class NamesAlone {
 public:
  NamesAlone(Search& search, const HoldOut& holdout);
  void put_back() const;
  /// Whether the model at hand, with laws, stands in their place: held-out data do not speak
  /// against it. Where a name is no part of it any more, and a form is not established or held-out
  /// data show something beside it, it also leaves much less than the names, which are
  /// approximations on most machines as well (kInPlaceOfName).
  bool give_way_to(const Laws& laws) const;

 private:
  bool are_kept() const;

  Search& search_;
  const HoldOut& holdout_;
  std::vector<Member> members_;
  Signals prediction_;
};

}  // namespace dcnn
