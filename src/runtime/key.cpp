#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>

#include "dcnn/core/error.h"
#include "dcnn/runtime/packet.h"

namespace dcnn {

PacketKey read_packet_key(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) {
    fail(Exit::kUsage, path.string(), ": cannot open the key: ", std::strerror(errno),
         "; make one with dcnn-run --make-key ", path.string());
  }
  PacketKey key;
  std::uint8_t beyond;
  struct stat about {};
  const bool known = ::fstat(file, &about) == 0 && S_ISREG(about.st_mode);
  const bool whole = known && ::read(file, key.data(), key.size()) == ssize_t(key.size()) &&
                     ::read(file, &beyond, 1) == 0;
  ::close(file);
  require(whole, Exit::kUsage, path.string(),
          ": a key is a file of exactly 32 bytes; make one with dcnn-run --make-key");
  require((about.st_mode & 077) == 0, Exit::kUsage, path.string(),
          ": others may read or change this key; run chmod 600 ", path.string());
  return key;
}

void make_packet_key(const std::filesystem::path& path) {
  require(sodium_init() >= 0, Exit::kFailure, "no source of randomness");
  PacketKey key;
  randombytes_buf(key.data(), key.size());
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) {
    fail(errno == EEXIST ? Exit::kUsage : Exit::kFailure, path.string(),
         ": cannot make the key: ", std::strerror(errno));
  }
  const bool whole =
      ::write(file, key.data(), key.size()) == ssize_t(key.size()) && ::fsync(file) == 0;
  ::close(file);
  if (!whole) ::unlink(path.c_str());
  require(whole, Exit::kFailure, path.string(), ": cannot write the key");
}

}  // namespace dcnn
