// SPDX-License-Identifier: Apache-2.0
#include "dcnn/experiment/bench.h"

#include <iostream>

#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/experiment/peers.h"
#include "support/interrupt.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-bench model.dcnn\n"
    "  dcnn-bench model.dcnn --data data/sample/test.csv --lengths 1,5,10 --out timing\n"
    "  dcnn-bench a.dcnn b.dcnn --repetitions 3 --json | jq .rows\n"
    "  dcnn-bench --peers --out timing          # the paper's networks beside other libraries\n"
    "  dcnn-bench --peers model.dcnn            # a trained model's\n";

Peers compare(const PeersRequest& request, bool quiet) {
  Progress bar(quiet);
  try {
    const Peers peers = compare_with_peers(
        request, [&](double done, const std::string& what) { bar.update(done, what); });
    bar.clear();
    return peers;
  } catch (const Error&) {
    if (interrupted()) die_of_interrupt();
    throw;
  }
}

Bench time(const BenchRequest& request, bool quiet) {
  Progress bar(quiet);
  const Bench result = bench(request, [&](int done, int total) {
    if (interrupted()) die_of_interrupt();
    bar.update(double(done) / total, std::to_string(done) + "/" + std::to_string(total));
  });
  bar.clear();
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-bench",
            "Times predictions in calls of a few samples, on one pinned thread (Table I), and "
            "beside other libraries.",
            kExamples);
  BenchRequest request;
  PeersRequest peers_request;
  std::filesystem::path out;
  bool with_peers = false;
  tool.option("models", request.models, "model files").holds({FileKind::kModel});
  const Option data =
      tool.option("--data", request.data,
                  "recording to predict (default: 32045 rows drawn from the model's statistics)")
          .holds({FileKind::kRecording});
  const Option lengths = tool.option("--lengths", request.lengths,
                                     "samples per call (with --peers: 1,10,100,1000,10000,32045)")
                             .separated_by_commas()
                             .between(1, 100000)
                             .with_default();
  tool.option("--repetitions", request.repetitions, "passes over all samples")
      .between(1, 1000)
      .with_default();
  tool.option("--samples", request.samples, "rows that are drawn where there is no --data")
      .positive(10000000)
      .with_default()
      .excludes(data);
  tool.output("--out", out, "folder for bench.html and bench.json", {"bench.html", "bench.json"});
  tool.flag("--peers", with_peers,
            "beside ONNX Runtime, oneDNN and libtorch, as far as they are there "
            "(tools/install-deps --peers): the paper's networks, or those of the models");
  tool.option("--networks", peers_request.networks,
              "with --peers and no model: these of the paper's networks and trainings alone")
      .separated_by_commas()
      .one_of({"dcnn-valid", "dcnn-same", "lstm-1", "lstm-step", "lstm-10", "lstm-25",
               "lstm-25-online", "ffnn-s", "ffnn-m"});
  tool.option("--rounds", peers_request.rounds, "with --peers: turns of every library in a row")
      .between(1, 1000)
      .with_default();
  tool.option("--epochs", peers_request.epochs,
              "with --peers and no model: training epochs of each in turns, 0 for none")
      .between(0, 100)
      .with_default();
  const PrecisionFlag precision(tool);
  const ReadFlags read(tool);
  const SeedFlag seed_flag(tool);
  tool.shares_work();

  return tool.run(argc, argv, [&] {
    require(with_peers || !request.models.empty(), Exit::kUsage,
            "no model; give a file written by dcnn-train, or --peers");
    request.read = read.options();
    request.precision = precision.value();
    request.seed = seed_flag.value();
    const bool quiet = tool.common().quiet;
    std::optional<Peers> peers;  // first, while this process is on all processors
    if (with_peers) {
      peers_request.models = request.models;
      peers_request.helpers = std::filesystem::read_symlink("/proc/self/exe").parent_path();
      peers_request.seed = request.seed;
      if (lengths.given()) peers_request.batches = request.lengths;
      peers_request.stop_wanted = interrupted;
      catch_interrupts();  // its folder goes with it
      peers = compare(peers_request, quiet);
    }
    const Bench result = time(request, quiet);
    for (const auto& note : result.notes) tool.note(note);
    Json json = to_json(result);
    if (peers) json["peers"] = to_json(*peers);
    if (!out.empty()) {
      FileSet files(out);
      write_file(out / "bench.json", json.dump(2) + "\n");
      write_file(out / "bench.html", to_html(result, request, peers ? &*peers : nullptr));
      files.commit();
      tool.note("report      " + (out / "bench.html").string());
    }
    if (tool.common().json) {
      Tool::print(json);
    } else {
      if (!result.rows.empty()) std::cout << to_text(result);
      if (peers) std::cout << to_text(*peers);
    }
    require(!peers || peers->agree(), Exit::kFailure,
            "outputs differ from a peer's by more than they may: see 'difference'");
    return Exit::kDone;
  });
}
