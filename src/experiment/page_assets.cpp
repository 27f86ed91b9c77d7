// SPDX-License-Identifier: Apache-2.0
#include "experiment/page_assets.h"

// The assembler copies a file's bytes between two symbols.
#define ASSET(name, file)                                                                      \
  asm(".pushsection .rodata\n"                                                                 \
      ".global dcnn_asset_" #name "\ndcnn_asset_" #name ": .incbin \"" file "\"\n"              \
      ".global dcnn_asset_" #name "_end\ndcnn_asset_" #name "_end: .byte 0\n.popsection\n");    \
  extern "C" const char dcnn_asset_##name[], dcnn_asset_##name##_end[];

ASSET(style, DCNN_PAGE_DIR "/page.css")
ASSET(script, DCNN_PAGE_DIR "/page.js")
ASSET(plot_library, DCNN_DYGRAPHS_DIR "/dygraph.min.js")
ASSET(plot_style, DCNN_DYGRAPHS_DIR "/dygraph.min.css")

namespace dcnn {

std::string_view page_style() { return {dcnn_asset_style, dcnn_asset_style_end}; }
std::string_view page_script() { return {dcnn_asset_script, dcnn_asset_script_end}; }
std::string_view plot_library() {
  return {dcnn_asset_plot_library, dcnn_asset_plot_library_end};
}
std::string_view plot_style() { return {dcnn_asset_plot_style, dcnn_asset_plot_style_end}; }

}  // namespace dcnn
