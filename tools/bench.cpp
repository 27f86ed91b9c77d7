#include "dcnn/experiment/bench.h"

#include <iostream>

#include "dcnn/core/file.h"
#include "support/progress.h"
#include "support/tool.h"

namespace {

using namespace dcnn;

constexpr const char* kExamples =
    "  dcnn-bench model.dcnn\n"
    "  dcnn-bench model.dcnn --data data/sample/test.csv --lengths 1,5,10 --out timing\n"
    "  dcnn-bench a.dcnn b.dcnn --repetitions 3 --json | jq .rows\n";

}  // namespace

int main(int argc, char** argv) {
  Tool tool("dcnn-bench",
            "Times predictions in calls of a few samples, on one pinned thread (Table I).",
            kExamples);
  BenchRequest request;
  std::filesystem::path out;
  tool.option("models", request.models, "model files").required();
  tool.option("--data", request.data,
              "recording to predict (default: 32045 rows drawn from the model's statistics)");
  tool.option("--lengths", request.lengths, "samples per call")
      .separated_by_commas()
      .between(1, 100000)
      .with_default();
  tool.option("--repetitions", request.repetitions, "passes over all samples")
      .between(1, 1000)
      .with_default();
  tool.option("--out", out, "folder for bench.html and bench.json");
  const ReadFlags read(tool);

  return tool.run(argc, argv, [&] {
    request.read = read.options();
    request.seed = tool.common().seed.value_or(1);
    Progress bar(tool.common().quiet);
    const Bench result = bench(request, [&](int done, int total) {
      bar.update(double(done) / total, std::to_string(done) + "/" + std::to_string(total));
    });
    bar.clear();
    for (const auto& note : result.notes) tool.note(note);
    if (!out.empty()) {
      write_file(out / "bench.json", to_json(result).dump(2) + "\n");
      write_file(out / "bench.html", to_html(result, request));
      tool.note("report      " + (out / "bench.html").string());
    }
    if (tool.common().json) {
      Tool::print(to_json(result));
    } else {
      std::cout << to_text(result);
    }
    return Exit::kDone;
  });
}
