// Effects too faint for the fitted recordings alone, which held-out recordings bear out.
#pragma once

#include "diagnosis/holdout.h"
#include "diagnosis/search.h"

namespace dcnn {

/// Where nothing was found and nothing remains: adds the name that is likeliest by evidence of the
/// fitted rows and support of the held-out ones together, if it is likelier than none.
void add_faint(Search& search, const HoldOut& holdout);

}  // namespace dcnn
