// SPDX-License-Identifier: Apache-2.0
// The programs are hardened as SECURITY.md says, read from the programs themselves.
#include <elf.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "support/process.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

/// What a 64-bit ELF file says of itself.
class Program {
 public:
  explicit Program(const std::filesystem::path& path) : bytes_(mapped(path)) {
    if (bytes_.size() < sizeof(Elf64_Ehdr)) return;
    header_ = at<Elf64_Ehdr>(0);
    for (std::size_t k = 0; k < header_.e_phnum; ++k) {
      const auto segment = at<Elf64_Phdr>(header_.e_phoff + k * sizeof(Elf64_Phdr));
      segments_.push_back(segment);
      if (segment.p_type == PT_DYNAMIC) read_dynamic(segment);
    }
    for (std::size_t k = 0; k < header_.e_shnum; ++k) {
      const auto section = at<Elf64_Shdr>(header_.e_shoff + k * sizeof(Elf64_Shdr));
      if (section.sh_type == SHT_DYNSYM) read_symbols(section);
    }
  }

  bool is_elf() const { return bytes_.starts_with(ELFMAG); }
  bool is_position_independent() const {
    return header_.e_type == ET_DYN && (flags1_ & DF_1_PIE) != 0;
  }
  bool binds_at_start() const { return (flags1_ & DF_1_NOW) != 0 || (flags_ & DF_BIND_NOW) != 0; }
  bool has(Elf64_Word type) const { return segment(type) != nullptr; }
  bool stack_is_data() const {
    const Elf64_Phdr* stack = segment(PT_GNU_STACK);
    return stack != nullptr && (stack->p_flags & PF_X) == 0;
  }
  bool writes_no_code() const {
    for (const auto& s : segments_) {
      if (s.p_type == PT_LOAD && (s.p_flags & PF_X) != 0 && (s.p_flags & PF_W) != 0) return false;
    }
    return true;
  }
  bool calls(const std::string& symbol) const { return symbols_.contains(symbol); }
  bool calls_checked_functions() const {
    return std::any_of(symbols_.begin(), symbols_.end(), [](const std::string& name) {
      return name.starts_with("__") && name.ends_with("_chk");
    });
  }
  /// Whether ENDBR64 stands in it so often.
  bool has_jump_targets(int wanted) const {
    constexpr std::string_view kMark = "\xf3\x0f\x1e\xfa";
    auto at = bytes_.find(kMark);
    for (int count = 1; count < wanted && at != bytes_.npos; ++count) {
      at = bytes_.find(kMark, at + 1);
    }
    return at != bytes_.npos;
  }

 private:
  template <class T>
  T at(std::size_t place) const {
    T value{};
    if (place + sizeof(T) <= bytes_.size()) std::memcpy(&value, bytes_.data() + place, sizeof(T));
    return value;
  }
  const Elf64_Phdr* segment(Elf64_Word type) const {
    for (const auto& s : segments_) {
      if (s.p_type == type) return &s;
    }
    return nullptr;
  }
  void read_dynamic(const Elf64_Phdr& segment) {
    for (std::size_t place = 0; place < segment.p_filesz; place += sizeof(Elf64_Dyn)) {
      const auto entry = at<Elf64_Dyn>(segment.p_offset + place);
      if (entry.d_tag == DT_FLAGS) flags_ = entry.d_un.d_val;
      if (entry.d_tag == DT_FLAGS_1) flags1_ = entry.d_un.d_val;
    }
  }
  void read_symbols(const Elf64_Shdr& section) {
    const auto names = at<Elf64_Shdr>(header_.e_shoff + section.sh_link * sizeof(Elf64_Shdr));
    for (std::size_t place = 0; place < section.sh_size; place += sizeof(Elf64_Sym)) {
      const auto symbol = at<Elf64_Sym>(section.sh_offset + place);
      if (symbol.st_shndx != SHN_UNDEF) continue;
      const auto name = bytes_.substr(names.sh_offset + symbol.st_name);
      symbols_.emplace(name.substr(0, name.find('\0')));
    }
  }

  /// The file's bytes, of which only those that are looked at are read, until the test program
  /// ends.
  static std::string_view mapped(const std::filesystem::path& path) {
    const auto size = std::filesystem::file_size(path);
    const int file = ::open(path.c_str(), O_RDONLY);
    void* const bytes = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
    ::close(file);
    return bytes == MAP_FAILED ? std::string_view()
                               : std::string_view(static_cast<const char*>(bytes), size);
  }

  std::string_view bytes_;
  Elf64_Ehdr header_{};
  std::vector<Elf64_Phdr> segments_;
  std::set<std::string> symbols_;
  Elf64_Xword flags_ = 0, flags1_ = 0;
};

TEST(Hardened, EveryProgramIs) {
#ifndef DCNN_HARDENED
  GTEST_SKIP() << "DCNN_HARDENED is off in this build";
#endif
  if (test::kSanitized) GTEST_SKIP() << "sanitizers take other precautions";
  int programs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(DCNN_BIN_DIR)) {
    const Program program(entry.path());
    if (!program.is_elf()) continue;
    SCOPED_TRACE(entry.path().string());
    EXPECT_TRUE(program.is_position_independent());
    EXPECT_TRUE(program.binds_at_start());
    EXPECT_TRUE(program.has(PT_GNU_RELRO));
    EXPECT_TRUE(program.stack_is_data());
    EXPECT_TRUE(program.writes_no_code());
    EXPECT_TRUE(program.calls("__stack_chk_fail"));
#ifdef __x86_64__
    // Debian 12's start files have no CET property, so that programs are not marked as a whole; the
    // targets of jumps in our code are.
    EXPECT_TRUE(program.has_jump_targets(10));
#endif
    programs += program.calls_checked_functions();
  }
  EXPECT_GE(programs, 5) << "with checked string functions";
}

}  // namespace
}  // namespace dcnn
