// SPDX-License-Identifier: Apache-2.0
// Files that become parts of every page, compiled into the library.
#pragma once

#include <string_view>

namespace dcnn {

std::string_view page_style();   ///< src/experiment/page/page.css
std::string_view page_script();  ///< src/experiment/page/page.js
std::string_view plot_library();  ///< dygraphs (MIT), from the package libjs-dygraphs
std::string_view plot_style();

}  // namespace dcnn
