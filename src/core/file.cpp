#include "dcnn/core/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <charconv>
#include <cstdint>
#include <cstring>

#include "core/descriptor.h"
#include "dcnn/core/ranks.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

/// Fails with errno's words unless `ok`: read here, after the call, which an argument of require()
/// may come before.
void check(bool ok, Exit exit, const fs::path& path, const char* what) {
  if (!ok) fail(exit, path.string(), ": ", what, ": ", std::strerror(errno));
}

void make_folder(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  fs::create_directories(folder, error);
  require(!error, Exit::kFailure, folder.string(), ": cannot make this folder: ", error.message());
}

/// Where bytes for a path go: into an open descriptor, or into what the path's last link names.
struct Target {
  int descriptor = -1;
  fs::path file;
};

/// The number of an open descriptor that a path such as /dev/fd/1 names, -1 for other paths.
int named_descriptor(const fs::path& path) {
  if (path == "-") return STDOUT_FILENO;
  const fs::path folder = path.parent_path();
  if (folder != "/proc/self/fd" && folder != "/dev/fd") return -1;
  const std::string name = path.filename();
  int number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc() && end == name.data() + name.size() ? number : -1;
}

Target target_of(fs::path path) {
  constexpr int kMostLinks = 40;  // Linux follows as many
  for (int links = 0; links <= kMostLinks; ++links) {
    if (const int descriptor = named_descriptor(path); descriptor >= 0) return {descriptor, {}};
    std::error_code error;
    const fs::path next = fs::read_symlink(path, error);
    if (error) return {-1, path};
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  fail(Exit::kFailure, path.string(), ": too many links");
}

bool is_stream(const fs::path& file) {
  struct stat info {};
  return ::stat(file.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

/// A name in the folder lasts only once the folder is on the disk. Not every file system can, and
/// not every folder may be read.
void sync_folder(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  Descriptor fd(
      completed([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }));
  if (fd.get() < 0) return;
  const bool done = completed([&] { return ::fsync(fd.get()); }) == 0;
  check(done || errno == EINVAL || errno == ENOTSUP, Exit::kFailure, folder, "cannot write");
}

std::string read_standard_input(std::size_t max_bytes, Exit exit) {
  std::string bytes;
  char chunk[1 << 16];
  for (;;) {
    const auto got = completed([&] { return ::read(STDIN_FILENO, chunk, sizeof chunk); });
    check(got >= 0, exit, "standard input", "cannot read");
    if (got == 0) return bytes;
    require(bytes.size() + static_cast<std::size_t>(got) <= max_bytes, exit,
            "standard input: larger than ", max_bytes, " bytes");
    bytes.append(chunk, static_cast<std::size_t>(got));
  }
}

/// Bytes on the disk under a name beside `path` that nobody can have foreseen or linked elsewhere.
class Temporary {
 public:
  Temporary(const fs::path& path, std::string_view bytes, mode_t mode) {
    Descriptor fd(create(path, mode));
    check(fd.get() >= 0, Exit::kFailure, path, "cannot write");
    try {
      const bool written = write_all(fd.get(), bytes);
      check(written, Exit::kFailure, path, "cannot write");
      const bool synced = completed([&] { return ::fsync(fd.get()); }) == 0;
      check(synced, Exit::kFailure, path, "cannot write");
    } catch (const Error&) {
      ::unlink(name_.c_str());
      throw;
    }
  }
  ~Temporary() { ::unlink(name_.c_str()); }  // after a rename there is none
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const char* name() const { return name_.c_str(); }

 private:
  int create(const fs::path& path, mode_t mode) {
    constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kTries = 10;
    int fd = -1;
    errno = EEXIST;
    for (int i = 0; i < kTries && fd < 0 && errno == EEXIST; ++i) {
      std::uint64_t word = 0;
      if (::getentropy(&word, sizeof word) != 0) return -1;
      name_ = path.string() + ".tmp" + std::to_string(word);
      fd = completed([&] { return ::open(name_.c_str(), kFlags, mode); });
    }
    return fd;
  }

  std::string name_;
};

void replace_file(const fs::path& path, std::string_view bytes) {
  struct stat old {};
  const mode_t mode = ::stat(path.c_str(), &old) == 0 ? old.st_mode & 0777 : 0644;
  const Temporary temporary(path, bytes, mode);
  const bool renamed = ::rename(temporary.name(), path.c_str()) == 0;
  check(renamed, Exit::kFailure, path, "cannot replace");
  sync_folder(path);
}

}  // namespace

std::string read_file(const fs::path& path, std::size_t max_bytes, Exit exit) {
  if (path == "-") return read_standard_input(max_bytes, exit);
  Descriptor fd(completed([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); }));
  check(fd.get() >= 0, exit, path, "cannot open");
  struct stat info {};
  const bool known = ::fstat(fd.get(), &info) == 0;
  check(known, exit, path, "cannot read");
  require(!S_ISDIR(info.st_mode), exit, path.string(), ": is a folder; name a file");
  require(S_ISREG(info.st_mode), exit, path.string(), ": is not a regular file");
  const auto size = static_cast<std::size_t>(info.st_size);
  require(size <= max_bytes, exit, path.string(), ": larger than ", max_bytes, " bytes");
  std::string bytes(size, '\0');
  const auto have = read_all(fd.get(), bytes.data(), size);
  check(have.has_value(), exit, path, "cannot read");
  bytes.resize(*have);
  return bytes;
}

void write_file(const fs::path& path, std::string_view bytes) {
  if (!is_first_rank()) return;
  const Target target = target_of(path);
  const auto put = [&](int stream) {
    const bool written = write_all(stream, bytes);
    check(written, Exit::kFailure, path, "cannot write");
  };
  if (target.descriptor >= 0) return put(target.descriptor);
  if (is_stream(target.file)) {
    Descriptor fd(completed([&] { return ::open(target.file.c_str(), O_WRONLY | O_CLOEXEC); }));
    check(fd.get() >= 0, Exit::kFailure, path, "cannot write");
    return put(fd.get());
  }
  make_folder(target.file.parent_path());
  replace_file(target.file, bytes);
}

std::optional<fs::path> replaced_file(const fs::path& path) {
  const Target target = target_of(path);
  std::error_code missing;
  if (target.descriptor >= 0 || !fs::is_regular_file(target.file, missing)) return std::nullopt;
  return target.file;
}

FolderLock::FolderLock(const fs::path& folder) {
  if (!is_first_rank()) return;
  make_folder(folder);
  folder_ = completed([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  check(folder_ >= 0, Exit::kFailure, folder, "cannot open this folder");
  // A file system that cannot lock folders (NFS) is not refused.
  const bool locked = completed([&] { return ::flock(folder_, LOCK_EX | LOCK_NB); }) == 0;
  if (locked || errno != EWOULDBLOCK) return;
  ::close(folder_);
  fail(Exit::kUsage, folder.string(),
       ": another process is writing here; wait for it or choose another --out");
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) ::close(folder_);
}

}  // namespace dcnn
