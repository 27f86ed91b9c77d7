// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "experiment/peers/epochs.h"
#include "experiment/peers/helpers.h"
#include "experiment/peers/measure.h"

namespace dcnn {
namespace {

constexpr Index kCompared = 1000;       // samples whose outputs are compared
constexpr double kMostProducts = 2e10;  // of a call: rows beyond take minutes
constexpr Index kThreadedBatch = 1000;  // from here on with all threads too

class Comparison {
 public:
  Comparison(const PeersRequest& request,
             const std::function<void(double, const std::string&)>& progress)
      : request_(request), progress_(progress), threads_(threads()) {}

  Peers run() {
    go_on();
    const auto cases = peer_cases(request_, result_.notes);
    helpers_ = open_helpers(request_.helpers, workplace_.path, result_.peers);
    for (const Helper& helper : helpers_) result_.peers.push_back(helper.peer);
    double done = 0.0;
    for (const PeerCase& what : cases) {
      if (progress_) progress_(done++ / static_cast<double>(cases.size()), what.name);
      compare(what);
    }
    set_threads(threads_);
    if (request_.epochs > 0 && request_.models.empty()) train();
    return std::move(result_);
  }

 private:
  void go_on() const {
    if (request_.stop_wanted && request_.stop_wanted()) fail(Exit::kFailure, "stopped");
  }

  /// Does this for every library; one that fails is left out from then on, with a note.
  template <class Work>
  void guarded(const Work& work) {
    std::erase_if(helpers_, [&](Helper& helper) {
      try {
        work(helper);
        return false;
      } catch (const Error& error) {
        result_.notes.push_back(std::string(error.what()) + "; left out from here on");
        return true;
      }
    });
  }

  std::vector<Index> batches(double products_of_one) const {
    std::vector<Index> chosen;
    for (const Index batch : request_.batches) {
      if (static_cast<double>(batch) * products_of_one <= kMostProducts) chosen.push_back(batch);
    }
    return chosen;
  }

  void compare(const PeerCase& what) {
    const double each = products(what.network, what.succession == Succession::kCarries);
    auto chosen = batches(each);
    if (what.succession != Succession::kNone)
      std::erase_if(chosen, [](Index batch) { return batch != 1; });
    if (chosen.empty()) return;
    const Index most = std::max<Index>(kCompared, *std::ranges::max_element(chosen));
    const bool slides = what.succession == Succession::kSlides;
    const Tensor x = (slides ? drawn_windows : drawn_samples)(what.network, most, request_.seed);
    write_case(workplace_.path, what, x);
    guarded([](const Helper& helper) {
      if (!helper.peer.host.empty()) helper.load_nothing();
    });
    for (const Index batch : chosen) {
      for (const int threads : {1, threads_}) {
        go_on();
        if (threads > 1 && batch < kThreadedBatch) continue;
        compare(what, x, each, batch, threads);
        if (threads_ == 1) break;
      }
    }
  }

  void compare(const PeerCase& what, const Tensor& x, double each, Index batch, int threads) {
    PeersRow row;
    row.network = what.name;
    row.batch = batch;
    row.threads = threads;
    row.products = each * static_cast<double>(batch);
    Ours ours(what, x, batch, threads);
    const std::vector<double> wanted = ours.outputs(kCompared);
    std::map<std::string, double> differences;
    guarded([&](const Helper& helper) {
      helper.load(batch, threads);
      differences[helper.peer.name] = difference(helper, wanted);
    });
    std::vector<std::unique_ptr<Theirs>> theirs;
    std::vector<Contestant*> contestants{&ours};
    for (const Helper& helper : helpers_) {
      theirs.push_back(std::make_unique<Theirs>(*helper.child, !helper.peer.host.empty()));
      contestants.push_back(theirs.back().get());
    }
    Measured measured;
    try {
      measured = measure(contestants, request_.rounds, threads);
    } catch (const Error& error) {
      result_.notes.push_back(std::string(error.what()) + "; a row of " + what.name +
                              " is left out");
      return;
    }
    const Turns& own = measured.contestants[0];
    row.peak = measured.peak;
    row.ours = own.times;
    row.loop_tail = measured.loop_tail;
    for (std::size_t i = 0; i < helpers_.size(); ++i) {
      row.peers.push_back(result_of(helpers_[i].peer.name, own, measured.contestants[i + 1]));
      row.peers.back().difference = differences[helpers_[i].peer.name];
    }
    result_.rows.push_back(std::move(row));
  }

  static PeerResult result_of(const std::string& peer, const Turns& ours, const Turns& theirs) {
    PeerResult result;
    result.peer = peer;
    result.call = theirs.times;
    result.overhead = median_of(theirs.overhead);
    std::vector<double> ratios, net;
    for (std::size_t k = 0; k < ours.calls.size(); ++k) {
      ratios.push_back(theirs.calls[k] / ours.calls[k]);
      net.push_back(theirs.net[k] / ours.calls[k]);
    }
    result.ratio = median_of(ratios);
    result.ratio_net = median_of(net);
    const double cost = *std::ranges::min_element(theirs.overhead);
    result.ratio_least = std::max(0.0, theirs.times.least - cost) / ours.times.least;
    return result;
  }

  static double difference(const Helper& helper, const std::vector<double>& wanted) {
    const auto found = helper.outputs(kCompared);
    require(found.size() == wanted.size(), Exit::kFailure, helper.peer.name,
            ": answered another number of outputs");
    double greatest = 0.0, scale = 0.0;
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      greatest = std::max(greatest, std::abs(found[k] - wanted[k]));
      scale = std::max(scale, std::abs(wanted[k]));
    }
    return greatest / scale;
  }

  void train() {
    for (const char* network : {"dcnn-valid", "dcnn-same", "lstm-1", "lstm-10", "lstm-25"}) {
      if (!is_asked(request_, network)) continue;
      if (progress_) progress_(1.0, std::string("epochs of ") + network);
      go_on();
      guarded([&](Helper& helper) {
        if (!helper.peer.trains) return;
        result_.epochs.push_back(
            compare_epochs(*helper.child, helper.peer.name, network, request_.epochs));
      });
    }
  }

  const PeersRequest& request_;
  const std::function<void(double, const std::string&)>& progress_;
  int threads_;
  Workplace workplace_;
  std::vector<Helper> helpers_;
  Peers result_;
};

}  // namespace

const Peer& Peers::peer(const std::string& name) const {
  return *std::ranges::find(peers, name, &Peer::name);
}

bool Peers::agree() const {
  for (const PeersRow& row : rows) {
    for (const PeerResult& peer : row.peers) {
      if (!(peer.difference <= kTolerance)) return false;
    }
  }
  return true;
}

Peers compare_with_peers(const PeersRequest& request,
                         const std::function<void(double, const std::string&)>& progress) {
  return Comparison(request, progress).run();
}

}  // namespace dcnn
