// From the best of the dictionary to the law itself: changes of its form, each fitted.
#pragma once

#include "discovery/refine.h"

namespace dcnn::discovery {

/// The forms that were fitted, the best score first: the given ones, and changes of the best of
/// them for as long as these gain.
std::vector<Trial> evolved(const Data& data, std::vector<Trial> trials);

}  // namespace dcnn::discovery
