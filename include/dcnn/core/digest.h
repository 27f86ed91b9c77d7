// SPDX-License-Identifier: Apache-2.0
// SHA-256: checksums of model files, identities of data and of finished work.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace dcnn {

/// 64 lower-case hex digits of the SHA-256 over the parts one after the other.
std::string sha256_hex(std::initializer_list<std::string_view> parts);

}  // namespace dcnn
