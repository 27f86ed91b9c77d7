// SPDX-License-Identifier: Apache-2.0
// Several processes that train one network: the bytes of one process.
#include "dcnn/core/ranks.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>

#include "dcnn/core/file.h"
#include "support.h"
#include "support/process.h"

namespace dcnn {
namespace {

/// Ranks that exchange through memory that a fork shares.
class ForkedRanks final : public Ranks {
 public:
  static constexpr std::size_t kMostBytes = 1 << 22;
  struct Shared {
    pthread_barrier_t barrier;
    std::byte bytes[kMostBytes];
  };

  static Shared* make(int count) {
    void* memory =
        ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    auto* shared = static_cast<Shared*>(memory);
    pthread_barrierattr_t attributes;
    pthread_barrierattr_init(&attributes);
    pthread_barrierattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
    pthread_barrier_init(&shared->barrier, &attributes, static_cast<unsigned>(count));
    return shared;
  }

  ForkedRanks(int index, int count, Shared* shared) : Ranks(index, count), shared_(shared) {}
  void share(std::byte* data, const std::vector<Index>& offsets) override {
    const auto begin = offsets[static_cast<std::size_t>(index())],
               end = offsets[static_cast<std::size_t>(index()) + 1];
    if (static_cast<std::size_t>(offsets.back()) > kMostBytes) ::_exit(9);
    std::memcpy(shared_->bytes + begin, data + begin, static_cast<std::size_t>(end - begin));
    pthread_barrier_wait(&shared_->barrier);
    std::memcpy(data, shared_->bytes, static_cast<std::size_t>(offsets.back()));
    pthread_barrier_wait(&shared_->barrier);
  }

 private:
  Shared* shared_;
};

/// Runs work(rank) in `count` processes; their exit codes.
std::vector<int> in_ranks(int count, const std::function<int(int)>& work) {
  ForkedRanks::Shared* shared = ForkedRanks::make(count);
  std::vector<pid_t> processes;
  for (int rank = 0; rank < count; ++rank) {
    processes.push_back(::fork());
    if (processes.back() != 0) continue;
    set_threads(1);  // OpenMP's threads do not survive a fork
    ForkedRanks ranks(rank, count, shared);
    set_ranks(&ranks);
    ::_exit(work(rank));
  }
  std::vector<int> codes;
  for (const pid_t process : processes) {
    int status = 0;
    ::waitpid(process, &status, 0);
    codes.push_back(WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
  }
  ::munmap(shared, sizeof(ForkedRanks::Shared));
  return codes;
}

class TrainedByRanks : public testing::TestWithParam<const char*> {
 protected:
  TrainedByRanks() {
    const ToolModel tool = test::swinging_tool();
    task_ = test::task_of(GetParam(), test::exact_recording(tool, "multisine", 500, 3), "pose");
    Json& training = task_.problem.configuration["training"];
    training["epochs"] = 2;
    training["batch"] = 120;  // 12 pieces: more than ranks, and no multiple of 8
    validation_ = test::samples_of(test::exact_recording(tool, "multisine", 100, 4), task_.problem);
  }
  std::string at(const std::string& name) const { return folder_ / name; }

  /// The model's bytes, as the first of so many processes writes them; its checkpoint where rank 0
  /// or another one stopped in step 3.
  std::string bytes(int count, int stopping_rank = -1) const {
    const std::string name = at("model" + std::to_string(count));
    const auto codes = in_ranks(count, [&](int rank) {
      int step = 0;
      FitSession session;
      session.stop_wanted = [&] { return rank == stopping_rank && ++step == 3; };
      Container checkpoint;
      session.save_checkpoint = [&](const Container& file) { checkpoint = file; };
      auto model = model_kind(GetParam(), Exit::kUsage).make(task_.problem);
      const bool finished = model->fit(task_.samples, validation_, session);
      write_file(name, encode(finished ? test::saved(*model) : checkpoint));
      return finished ? 0 : 75;
    });
    EXPECT_EQ(codes, std::vector<int>(static_cast<std::size_t>(count), stopping_rank < 0 ? 0 : 75));
    return test::slurp(name);
  }

  test::TemporaryFolder folder_;
  test::Task task_;
  Samples validation_;
};

TEST_P(TrainedByRanks, HasTheBytesOfOneProcess) {
  const std::string one = bytes(1);
  ASSERT_GT(one.size(), 1000U);
  for (const int count : {2, 3, 8, 16}) EXPECT_EQ(bytes(count), one) << count;
}

TEST_P(TrainedByRanks, StopsInTheSameStepWhicheverRankIsAsked) {
  const std::string one = bytes(1, 0);
  EXPECT_EQ(bytes(4, 2), one);
}

INSTANTIATE_TEST_SUITE_P(Of, TrainedByRanks, testing::Values("dcnn", "dcnn-t", "mlp"),
                         [](const auto& name) {
                           std::string word = name.param;
                           std::erase(word, '-');
                           return word;
                         });

}  // namespace
}  // namespace dcnn
