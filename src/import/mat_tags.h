// SPDX-License-Identifier: Apache-2.0
// The outline of a MATLAB file of version 5 or 4: where its variables begin and end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace dcnn {

/// Whether a file that begins so is one of version 4, which has no words at its head: type 1000 M +
/// 10 P + T (M byte order, P precision, T kind), rows, columns, imaginary part, length of the name,
/// name.
bool is_mat4(std::string_view first_bytes);

struct MatOutline {
  std::uint64_t whole = 0;  ///< variables that end within the file
  bool cut = false;         ///< the last one runs past its end
};

/// Reads the tag (type, size: 32 bits each, in the byte order of the header; of version 4 see
/// above) of every variable up to the end of the file. Of a file of version 7.3 (HDF5, which checks
/// its own length) it says nothing.
MatOutline outline_of_mat(const std::filesystem::path& path);

}  // namespace dcnn
