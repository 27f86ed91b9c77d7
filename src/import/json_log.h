// SPDX-License-Identifier: Apache-2.0
// Logs in JSON.
#pragma once

#include <filesystem>
#include <string_view>

#include "import/log_builder.h"

namespace dcnn {

/// Whether a file that begins so holds JSON: an object, or a list of objects or lists.
bool is_json(std::string_view begin);

/// A record a line (JSON Lines); a list of records; lists of numbers by name, at any depth. Records
/// of one set of fields are one stream, lists of one length are one stream. Numbers that are NaN or
/// null are missing; texts are numbers or dates, or are left out. Error(kData) of a document that
/// is no JSON or longer than 64 MB.
void read_json_log(const std::filesystem::path& path, LogBuilder& builder);

}  // namespace dcnn
