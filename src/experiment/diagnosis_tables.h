// SPDX-License-Identifier: Apache-2.0
// The tables of a diagnosis' page.
#pragma once

#include <string>

#include "dcnn/core/json.h"
#include "dcnn/experiment/report.h"

namespace dcnn {

/// The error on held-out data, stage by stage, and the verdict.
void add_errors(const Json& report, HtmlReport& page);
void add_findings(const Json& report, HtmlReport& page);
void add_places(const Json& report, HtmlReport& page);
/// What was not found, and from which size on it would have been.
void add_limits(const Json& report, HtmlReport& page);

}  // namespace dcnn
