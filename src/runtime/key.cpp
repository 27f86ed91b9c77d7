// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>

#include <cstring>

#include "core/descriptor.h"
#include "dcnn/core/error.h"
#include "dcnn/runtime/packet.h"

namespace dcnn {

PacketKey read_packet_key(const std::filesystem::path& path) {
  constexpr int kFlags = O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  const Descriptor file(completed([&] { return ::open(path.c_str(), kFlags); }));
  if (file.get() < 0) {
    fail(Exit::kUsage, path.string(), ": cannot open the key: ", std::strerror(errno),
         "; make one with dcnn-run --make-key ", path.string());
  }
  struct stat about {};
  const bool regular = ::fstat(file.get(), &about) == 0 && S_ISREG(about.st_mode);
  char bytes[std::tuple_size_v<PacketKey> + 1];  // one more than a key has
  const auto size = regular ? read_all(file.get(), bytes, sizeof bytes) : 0;
  if (!size) fail(Exit::kUsage, path.string(), ": cannot read the key: ", std::strerror(errno));
  PacketKey key;
  require(*size == key.size(), Exit::kUsage, path.string(),
          ": a key is a file of exactly 32 bytes; make one with dcnn-run --make-key");
  require((about.st_mode & 077) == 0, Exit::kUsage, path.string(),
          ": others may read or change this key; run chmod 600 ", path.string());
  std::memcpy(key.data(), bytes, key.size());
  return key;
}

void make_packet_key(const std::filesystem::path& path) {
  require(sodium_init() >= 0, Exit::kFailure, "no source of randomness");
  PacketKey key{};
  randombytes_buf(key.data(), key.size());
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
  const Descriptor file(completed([&] { return ::open(path.c_str(), kFlags, 0600); }));
  if (file.get() < 0) {
    fail(errno == EEXIST ? Exit::kUsage : Exit::kFailure, path.string(),
         ": cannot make the key: ", std::strerror(errno));
  }
  const bool whole =
      write_all(file.get(), {reinterpret_cast<const char*>(key.data()), key.size()}) &&
      completed([&] { return ::fsync(file.get()); }) == 0;
  if (whole) return;
  const int error = errno;
  ::unlink(path.c_str());
  fail(Exit::kFailure, path.string(), ": cannot write the key: ", std::strerror(error));
}

}  // namespace dcnn
