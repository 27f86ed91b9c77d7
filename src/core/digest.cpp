// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/digest.h"

#include <sodium.h>

#include "dcnn/core/error.h"

namespace dcnn {

std::string sha256_hex(std::initializer_list<std::string_view> parts) {
  require(sodium_init() >= 0, Exit::kFailure, "libsodium does not start on this machine");
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  for (const std::string_view part : parts) {
    crypto_hash_sha256_update(&state, reinterpret_cast<const unsigned char*>(part.data()),
                              part.size());
  }
  unsigned char hash[crypto_hash_sha256_BYTES];
  crypto_hash_sha256_final(&state, hash);
  char hex[2 * sizeof hash + 1];
  return sodium_bin2hex(hex, sizeof hex, hash, sizeof hash);
}

}  // namespace dcnn
