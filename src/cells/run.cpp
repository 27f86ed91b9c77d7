// SPDX-License-Identifier: Apache-2.0
#include "dcnn/cells/run.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <deque>
#include <memory>
#include <set>

#include "cells/cell_process.h"
#include "dcnn/cells/pack.h"
#include "dcnn/core/file.h"

namespace dcnn {
namespace {

namespace fs = std::filesystem;

extern "C" void on_child(int) {}

/// While it lives, the end of a child interrupts wait() and nothing else.
class ChildSignal {
 public:
  ChildSignal() {
    struct sigaction action {};
    action.sa_handler = on_child;
    sigemptyset(&action.sa_mask);
    ::sigaction(SIGCHLD, &action, &before_);
    sigset_t child;
    sigemptyset(&child);
    sigaddset(&child, SIGCHLD);
    ::sigprocmask(SIG_BLOCK, &child, &mask_);
    waiting_ = mask_;
    sigdelset(&waiting_, SIGCHLD);
  }
  ~ChildSignal() {
    ::sigaction(SIGCHLD, &before_, nullptr);
    ::sigprocmask(SIG_SETMASK, &mask_, nullptr);
  }
  ChildSignal(const ChildSignal&) = delete;
  ChildSignal& operator=(const ChildSignal&) = delete;

  /// Until a child ends, any other signal comes, or 0.2 s have passed.
  void wait() const {
    constexpr timespec kLongest{0, 200'000'000};
    ::ppoll(nullptr, 0, &kLongest, &waiting_);
  }

 private:
  struct sigaction before_ {};
  sigset_t mask_{}, waiting_{};
};

/// A folder that nobody else has, gone with all in it in the end.
class ScratchFolder {
 public:
  explicit ScratchFolder(const fs::path& below) {
    std::string pattern = (below / "dcnn-cells-XXXXXX").string();
    if (!::mkdtemp(pattern.data())) {
      fail(Exit::kFailure, below.string(), ": cannot make a folder in it: ", std::strerror(errno),
           "; name another --scratch");
    }
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  fs::path next() { return path_ / std::to_string(++count_); }
  /// A machine without room fails, not the cells that meet it.
  void require_room() {
    constexpr std::size_t kProbe = 1 << 20;
    const fs::path probe = next();
    write_file(probe, std::string(kProbe, '\0'));
    fs::remove(probe);
  }

 private:
  fs::path path_;
  int count_ = 0;
};

struct Waiting {
  const Cell* cell;
  bool second_try;
};

class CellRunner {
 public:
  CellRunner(const CellRun& request, const CellRunObserver& observer)
      : request_(request),
        observer_(observer),
        plan_(read_plan(request.folder, request.shard)),
        surroundings_(request.root.empty() ? plan_.root : fs::absolute(request.root),
                      request.programs, plan_.threads),
        scratch_(request.scratch) {}

  CellRunOutcome run() {
    choose_cells();
    if (!queue_.empty()) check_programs();
    tell_progress();  // time is counted from here
    while (!queue_.empty() || !active_.empty()) {
      if (observer_.stop_wanted && observer_.stop_wanted()) {
        outcome_.finished = false;
        break;
      }
      while (!queue_.empty() && static_cast<int>(active_.size()) < request_.jobs) start_next();
      signal_.wait();
      std::erase_if(active_,
                    [&](Active& one) { return one.process->finished() && (end(one), true); });
    }
    end_all();
    return outcome_;
  }

 private:
  struct Active {
    std::unique_ptr<CellProcess> process;
    bool second_try;
  };

  void choose_cells() {
    std::set<std::string> keys;
    for (const Cell& cell : plan_.cells) keys.insert(cell.key);
    const PackIndex index =
        read_packs(request_.folder, [&](const std::string& key) { return keys.contains(key); });
    for (const std::string& line : index.broken) observer_.note(line);
    for (const Cell& cell : plan_.cells) {
      const auto found = index.results.find(cell.key);
      const bool done = found != index.results.end();
      if (done && (found->second.result.exit == 0 || !request_.again)) {
        ++outcome_.skipped;
      } else if (request_.limit == 0 || static_cast<int>(queue_.size()) < request_.limit) {
        queue_.push_back({&cell, false});
        weight_ += weight_of(cell);
      }
    }
    total_ = static_cast<std::int64_t>(queue_.size());
  }

  double weight_of(const Cell& cell) const { return request_.weight ? request_.weight(cell) : 1.0; }

  void check_programs() {
    for (const auto& [name, digest] : plan_.programs) {
      const fs::path file = request_.programs / name;
      require(
          fs::is_regular_file(file) && digests_.of(file) == digest, Exit::kUsage, file.string(),
          ": is not the program that the plan was made with; install the same one here, or plan "
          "again");
    }
  }

  void check_inputs(const Cell& cell) {
    for (const auto& [file, digest] : cell.inputs) {
      require(digests_.of(surroundings_.root / file) == digest, Exit::kData,
              (surroundings_.root / file).string(),
              ": is another file than when the plan was made; plan again");
    }
  }

  void start_next() {
    const Waiting next = queue_.front();
    queue_.pop_front();
    check_inputs(*next.cell);
    if (!pack_) pack_ = std::make_unique<PackWriter>(request_.folder, request_.shard);
    pack_->begin(next.cell->key);
    active_.push_back({std::make_unique<CellProcess>(*next.cell, surroundings_, scratch_.next()),
                       next.second_try});
  }

  void end(const Active& one) {
    const CellProcess& process = *one.process;
    const Cell& cell = process.cell();
    if (process.exit() == 0) {
      pack_->append(process.result());
      ++outcome_.done;
    } else {
      scratch_.require_room();
      if (!one.second_try) {
        queue_.push_back({&cell, true});
        return;
      }
      if (!process.ended_from_outside()) pack_->append(process.result());
      ++outcome_.failed;
      observer_.note(cell.name + ": failed twice with exit " + std::to_string(process.exit()) +
                     ": " + cell.command_line());
    }
    ended_weight_ += weight_of(cell);
    tell_progress();
  }

  void tell_progress() {
    if (total_ == 0) return;
    observer_.progress(ended_weight_ / weight_,
                       std::to_string(outcome_.done) + " of " + std::to_string(total_) + " cells");
  }

  /// Programs of ours save what they can when they are asked to end.
  void end_all() {
    constexpr int kMostWaits = 25;  // of 0.2 s; then SIGKILL
    for (const Active& one : active_) one.process->ask_to_end();
    for (int k = 0; k < kMostWaits && !active_.empty(); ++k) {
      signal_.wait();
      std::erase_if(active_, [](const Active& one) { return one.process->finished(); });
    }
    active_.clear();
  }

  const CellRun& request_;
  const CellRunObserver& observer_;
  CellPlan plan_;
  CellSurroundings surroundings_;
  ScratchFolder scratch_;
  ChildSignal signal_;
  FileDigests digests_;
  std::unique_ptr<PackWriter> pack_;
  std::deque<Waiting> queue_;
  std::vector<Active> active_;
  CellRunOutcome outcome_;
  std::int64_t total_ = 0;
  double weight_ = 0.0, ended_weight_ = 0.0;
};

}  // namespace

CellRunOutcome run_cells(const CellRun& request, const CellRunObserver& observer) {
  return CellRunner(request, observer).run();
}

}  // namespace dcnn
