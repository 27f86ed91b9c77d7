// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/provenance.h"

#include <utility>

namespace dcnn {
namespace {

Provenance& of_this_process() {
  static Provenance mine;
  return mine;
}

}  // namespace

void set_provenance(Provenance from) { of_this_process() = std::move(from); }
const Provenance& provenance() { return of_this_process(); }

}  // namespace dcnn
