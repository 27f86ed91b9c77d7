// SPDX-License-Identifier: Apache-2.0
// The posterior as it stands in report.json.
#pragma once

#include "dcnn/core/json.h"
#include "diagnosis/evidence/posterior.h"

namespace dcnn::evidence {

Json posterior_json(const Posterior& posterior);
/// Every structure that was weighed, with its logarithms.
Json structures_json(const Posterior& posterior);

}  // namespace dcnn::evidence
