// SPDX-License-Identifier: Apache-2.0
// Model files whose checksum is made right, so that everything behind it is read.
#include "dcnn/models/identifier.h"
#include "fuzz/support.h"
#include "sodium.h"

using namespace dcnn;

namespace {

void seal(std::string& bytes) {
  constexpr std::string_view kKey = R"("sha256":")";
  const auto found = bytes.find(kKey);
  if (found == bytes.npos || found + kKey.size() + 64 > bytes.size()) return;
  const auto place = found + kKey.size();
  bytes.replace(place, 64, std::string(64, '0'));
  unsigned char hash[32];
  crypto_hash_sha256(hash, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  char hex[65];
  bytes.replace(place, 64, sodium_bin2hex(hex, sizeof hex, hash, sizeof hash));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(fuzz::text_of(data, size));
  seal(bytes);
  fuzz::attempt([&] {
    const Identifier identifier = unpack(decode(bytes, "m.dcnn"), "m.dcnn");
    const auto predictor = identifier.model->predictor();
    predictor->push(identifier.model->map().mean());
  });
  return 0;
}
