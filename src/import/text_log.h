// SPDX-License-Identifier: Apache-2.0
// Text of any dialect as a log of one stream.
#pragma once

#include <filesystem>

#include "import/log_builder.h"

namespace dcnn {

/// `name`: of the stream; names of recipes must not depend on that of a file.
void read_text_log(const std::filesystem::path& path, const std::string& name, LogBuilder& builder);

}  // namespace dcnn
