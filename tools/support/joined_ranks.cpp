// SPDX-License-Identifier: Apache-2.0
#include "support/joined_ranks.h"

#ifdef DCNN_WITH_MPI
#include <mpi.h>
#endif
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "dcnn/core/error.h"
#include "dcnn/core/ranks.h"
#include "support/interrupt.h"

namespace dcnn {
namespace {

double monotonic_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// How many processes a launcher says that it has started: Open MPI's, or Slurm's and MPICH's.
int launched() {
  int most = 1;
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const char* text = std::getenv(name)) most = std::max(most, std::atoi(text));
  }
  return most;
}

#ifdef DCNN_WITH_MPI
/// Where one process dies mpirun asks the others to end, which wait in an exchange that never
/// completes; a user's wish to stop lets it complete. The first process tells which it was.
class DeathWatch {
 public:
  DeathWatch() : thread_([this](const std::stop_token& stop) { watch(stop); }) {}
  void enter() { entered_ = monotonic_s(); }
  void leave() { entered_ = 0.0; }

 private:
  void watch(const std::stop_token& stop) const {
    constexpr auto kLook = std::chrono::milliseconds(50);
    constexpr double kPatience_s = 0.5;  // mpirun kills 1 s after it has asked
    double asked = 0.0;
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(kLook);
      const double now = monotonic_s(), entered = entered_;
      if (!interrupted()) continue;
      if (asked == 0.0) asked = now;
      if (entered == 0.0 || now - std::max(entered, asked) < kPatience_s) continue;
      constexpr char kWords[] =
          "dcnn-train: one of its processes has died; the last checkpoint is kept, go on with the "
          "same command and --resume\n";
      ::_exit(::write(STDERR_FILENO, kWords, sizeof kWords - 1) < 0 ? 2 : 1);
    }
  }

  std::atomic<double> entered_{0.0};  ///< when the exchange under way began, 0: none
  std::jthread thread_;
};

class MpiRanks final : public Ranks {
 public:
  MpiRanks(int index, int count) : Ranks(index, count) {
    if (index == 0) watch_ = std::make_unique<DeathWatch>();
  }
  void share(std::byte* data, const std::vector<Index>& offsets) override {
    counts_.clear();
    starts_.clear();
    for (std::size_t r = 0; r + 1 < offsets.size(); ++r) {
      starts_.push_back(static_cast<int>(offsets[r]));
      counts_.push_back(static_cast<int>(offsets[r + 1] - offsets[r]));
    }
    if (watch_) watch_->enter();
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, data, counts_.data(), starts_.data(),
                   MPI_BYTE, MPI_COMM_WORLD);
    if (watch_) watch_->leave();
  }

 private:
  std::vector<int> counts_, starts_;
  std::unique_ptr<DeathWatch> watch_;
};
#endif

}  // namespace

JoinedRanks::JoinedRanks(std::string program)
    : program_(std::move(program)), begin_(monotonic_s()) {
  if (launched() == 1) return;
#ifdef DCNN_WITH_MPI
  int level = 0, index = 0, count = 1;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &index);
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  ranks_ = std::make_unique<MpiRanks>(index, count);
  set_ranks(ranks_.get());
  if (index > 0) fall_silent();
#else
  std::fprintf(
      stderr,
      "%s: started by mpirun, but built without MPI: its processes would overwrite one another; "
      "build with -DDCNN_WITH_MPI=ON\n",
      program_.c_str());
  std::exit(static_cast<int>(Exit::kUsage));
#endif
}

JoinedRanks::~JoinedRanks() { set_ranks(nullptr); }

void JoinedRanks::fall_silent() {
  loud_ = ::dup(STDERR_FILENO);
  const int kept = ::memfd_create("stderr", 0);
  if (!std::freopen("/dev/null", "w", stdout) || kept < 0 || ::dup2(kept, STDERR_FILENO) < 0) {
    ::close(loud_);
    loud_ = -1;
  }
}

void JoinedRanks::print_times() const {
  if (!ranks_ || !is_first_rank()) return;
  const double all = monotonic_s() - begin_;
  const ExchangeCost& cost = exchange_cost();
  std::fprintf(stderr, "%d processes: %.2f s, of which %.2f s exchanging (%lld times, %.1f MB)\n",
               ranks_->count(), all, cost.seconds, static_cast<long long>(cost.count),
               1e-6 * static_cast<double>(cost.bytes));
}

int JoinedRanks::leave(int code) {
#ifdef DCNN_WITH_MPI
  if (!ranks_) return code;
  if (code == static_cast<int>(Exit::kDone) || code == static_cast<int>(Exit::kInterrupted)) {
    MPI_Finalize();
    return code;
  }
  if (loud_ >= 0) {
    // What fails everywhere the first one has told by then, and ended all.
    std::this_thread::sleep_for(std::chrono::seconds(1));
    char line[2048];
    const auto size = ::pread(STDERR_FILENO, line, sizeof line, 0);
    if (size > 0 && ::write(loud_, line, static_cast<std::size_t>(size)) < 0)
      code = static_cast<int>(Exit::kFailure);
  }
  MPI_Abort(MPI_COMM_WORLD, code);
#endif
  return code;
}

}  // namespace dcnn
