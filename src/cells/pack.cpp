// SPDX-License-Identifier: Apache-2.0
#include "dcnn/cells/pack.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <tuple>

#include "dcnn/core/digest.h"
#include "dcnn/core/file.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigestDigits = 64;

double now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string host_name() {
  char name[256] = "";
  ::gethostname(name, sizeof name - 1);
  return name;
}

/// A line that tells whether it is whole.
std::string sealed(const Json& json) {
  const std::string text = json.dump();
  return sha256_hex({text}) + " " + text + "\n";
}

Json opened(const std::string& line) {
  if (line.size() < kDigestDigits + 2 || line[kDigestDigits] != ' ') return {};
  const std::string text = line.substr(kDigestDigits + 1);
  return sha256_hex({text}) == line.substr(0, kDigestDigits) ? Json::parse(text) : Json();
}

std::string digest_of(const CellResult& result, const Json& files) {
  return sha256_hex({std::to_string(result.exit), "\n", files.dump()});
}

/// "name": [bytes, SHA-256] of each file.
Json file_table(const CellResult& result) {
  Json files = Json::object();
  for (const auto& [name, bytes] : result.files) {
    files[name] = Json::array({bytes.size(), sha256_hex({bytes})});
  }
  return files;
}

PackedResult packed_from(const Json& header) {
  PackedResult packed;
  CellResult& result = packed.result;
  result.key = header["key"].get<std::string>();
  result.exit = header["exit"];
  result.seconds = header["seconds"];
  result.cpu_seconds = header["cpu_seconds"];
  result.memory_kb = header["memory_kb"];
  result.log = header["log"].get<std::string>();
  for (const auto& [name, file] : header["files"].items()) {
    packed.sizes.emplace_back(name, file[0].get<std::int64_t>());
    packed.digests[name] = file[1].get<std::string>();
  }
  packed.digest = digest_of(result, header["files"]);
  return packed;
}

/// Whether a lock is held on the pack: its writer lives.
bool is_held(const fs::path& pack) {
  const int descriptor = ::open(pack.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}

/// The files' bytes from here on, verified; false where they are not those of the header.
bool read_files(std::istream& in, const PackedResult& packed, CellResult& into) {
  for (const auto& [name, size] : packed.sizes) {
    std::string bytes(static_cast<std::size_t>(size), '\0');
    if (!in.read(bytes.data(), size) || sha256_hex({bytes}) != packed.digests.at(name))
      return false;
    into.files.emplace_back(name, std::move(bytes));
  }
  return true;
}

bool is_better(const PackedResult& a, const PackedResult& b) {
  if ((a.result.exit == 0) != (b.result.exit == 0)) return a.result.exit == 0;
  return std::tie(a.digest, a.pack) < std::tie(b.digest, b.pack);
}

void take(PackedResult found, PackIndex& index) {
  const auto [at, is_new] = index.results.try_emplace(found.result.key, found);
  if (is_new) return;
  PackedResult& known = at->second;
  const bool contradicted =
      known.contradicted ||
      (known.result.exit == 0 && found.result.exit == 0 && known.digest != found.digest);
  if (is_better(found, known)) known = std::move(found);
  known.contradicted = contradicted;
}

void read_pack(const fs::path& pack, const std::function<bool(const std::string&)>& wanted,
               PackIndex& index) {
  std::ifstream in(pack, std::ios::binary);
  const auto size = static_cast<std::int64_t>(fs::file_size(pack));
  std::map<std::string, RunningCell> begun;
  std::string line;
  for (std::int64_t at = 0; at < size && std::getline(in, line);) {
    const Json header = in.eof() ? Json() : opened(line);
    const std::int64_t after = at + static_cast<std::int64_t>(line.size()) + 1;
    if (header.is_null()) {
      // Without an end of line it is what a process wrote when it was killed.
      if (!in.eof())
        index.broken.push_back(pack.string() + ": damaged from byte " + std::to_string(at) + " on");
      break;
    }
    if (header.contains("begin")) {
      const auto key = header["begin"].get<std::string>();
      begun[key] = {key, header["host"].get<std::string>(), header["at"].get<double>()};
      at = after;
      continue;
    }
    PackedResult packed = packed_from(header);
    packed.pack = pack;
    packed.offset = after;
    at = after;
    for (const auto& [name, bytes] : packed.sizes) at += bytes;
    begun.erase(packed.result.key);
    if (at > size) break;
    if (wanted(packed.result.key)) {
      CellResult verified;
      if (read_files(in, packed, verified)) {
        take(std::move(packed), index);
        continue;  // the next record begins here
      } else {
        index.broken.push_back(pack.string() +
                               ": the bytes of a result are damaged; its cell is run again");
      }
    }
    in.clear();
    in.seekg(at);
  }
  const bool held = is_held(pack);
  for (auto& [key, cell] : begun) {
    if (held && wanted(key)) index.running.push_back(std::move(cell));
  }
}

}  // namespace

PackWriter::PackWriter(const fs::path& folder, Shard shard) {
  const fs::path packs =
      folder / "packs" / (std::to_string(shard.index) + "-of-" + std::to_string(shard.count));
  std::error_code error;
  fs::create_directories(packs, error);
  require(!error, Exit::kFailure, packs.string(), ": cannot make this folder: ", error.message());
  std::uint64_t word = 0;
  require(::getentropy(&word, sizeof word) == 0, Exit::kFailure,
          "this machine gives no random numbers");
  file_ = packs / (std::to_string(word) + ".pack");
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0)
    fail(Exit::kFailure, file_.string(), ": cannot write: ", std::strerror(errno));
  ::flock(descriptor_, LOCK_EX | LOCK_NB);  // file systems without locks lose --status' "running"
}

PackWriter::~PackWriter() {
  ::close(descriptor_);
  if (size_ == 0) ::unlink(file_.c_str());
}

void PackWriter::write(const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const auto wrote = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) {
      const int why = errno;
      // What is broken off would end the pack for readers; they stop there in any case.
      if (::ftruncate(descriptor_, size_) != 0) {
      }
      fail(Exit::kFailure, file_.string(), ": cannot write: ", std::strerror(why),
           "; results before this one are kept, the same command goes on");
    }
    done += static_cast<std::size_t>(wrote);
  }
  size_ += static_cast<std::int64_t>(bytes.size());
}

void PackWriter::begin(const std::string& key) {
  write(sealed({{"begin", key}, {"at", now_s()}, {"host", host_name()}}));
}

void PackWriter::append(const CellResult& result) {
  std::string record = sealed({{"key", result.key},
                               {"exit", result.exit},
                               {"seconds", result.seconds},
                               {"cpu_seconds", result.cpu_seconds},
                               {"memory_kb", result.memory_kb},
                               {"log", result.log},
                               {"files", file_table(result)}});
  for (const auto& file : result.files) record += file.second;
  write(record);
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP) {
    fail(Exit::kFailure, file_.string(), ": cannot write: ", std::strerror(errno));
  }
}

PackIndex read_packs(const fs::path& folder,
                     const std::function<bool(const std::string&)>& wanted) {
  std::vector<fs::path> packs;
  std::error_code missing;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "packs", missing)) {
    if (entry.path().extension() == ".pack") packs.push_back(entry.path());
  }
  std::sort(packs.begin(), packs.end());
  PackIndex index;
  for (const fs::path& pack : packs) {
    try {
      read_pack(pack, wanted, index);
    } catch (const std::exception& error) {
      index.broken.push_back(pack.string() + ": " + error.what());
    }
  }
  return index;
}

CellResult read_result(const PackedResult& packed) {
  std::ifstream in(packed.pack, std::ios::binary);
  in.seekg(packed.offset);
  CellResult result = packed.result;
  require(in && read_files(in, packed, result), Exit::kFailure, packed.pack.string(),
          ": a result of it changed while it was read; run the command again");
  return result;
}

}  // namespace dcnn
