// SPDX-License-Identifier: Apache-2.0
// A model file with a right checksum and wrong numbers is refused, or loaded and run, in bounded
// memory and time.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <ctime>
#include <fstream>

#include "dcnn/data/streaming_features.h"
#include "dcnn/models/identifier.h"
#include "models/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

constexpr double kWrong[] = {0.0, -1.0, 1e-9, 65537.0, 1e9, 1e300};
constexpr std::size_t kMoreMemory = std::size_t{192} << 20;  // a file here has up to 300 kB
constexpr double kMostSeconds = 1.0;

/// While it lives an allocation beyond what the process has and `kMoreMemory` fails.
class MemoryLimit {
 public:
  MemoryLimit() {
    ::getrlimit(RLIMIT_AS, &before_);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit = before_;
    limit.rlim_cur = pages * 4096 + kMoreMemory;
    if (!test::kSanitized) ::setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { ::setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_{};
};

/// The first and the last number below a value, each set to something wrong, one at a time.
void each_wrong(Json& value, const std::string& path, const std::function<void(std::string)>& run) {
  if (value.is_number()) {
    const Json right = value;
    for (const double wrong : kWrong) {
      if (right.is_number_integer() && std::abs(wrong) >= 1.0 && std::abs(wrong) < 1e18) {
        value = static_cast<std::int64_t>(wrong);
      } else {
        value = wrong;
      }
      std::ostringstream words;
      words << path << " = " << wrong;
      run(words.str());
    }
    value = right;
  } else if (value.is_array()) {
    for (std::size_t k = 0; k < value.size(); k += std::max<std::size_t>(1, value.size() - 1)) {
      each_wrong(value.at(k), path + "[" + std::to_string(k) + "]", run);
    }
  } else if (value.is_object()) {
    for (auto& [key, item] : value.items()) each_wrong(item, path + "." + key, run);
  }
}

class HostileNumbers : public testing::TestWithParam<const char*> {
 protected:
  HostileNumbers() {
    const Recording log = test::exact_recording(test::swinging_tool(), "multisine", 300, 3);
    const std::string kind = GetParam();
    const std::string set = kind == "rigid" || kind == "mlp" ? "body" : "pose";
    test::Task task = test::task_of(kind, log, set);
    task.problem.layout.spec.derivative = causal_derivative();
    Json& json = task.problem.configuration;
    if (json["training"].contains("epochs")) json["training"]["epochs"] = 1;
    if (json["training"].contains("batch")) json["training"]["batch"] = 50;
    identifier_.name = kind;
    identifier_.layout = task.problem.layout;
    identifier_.targets = task.problem.targets;
    identifier_.configuration = json;
    identifier_.model = test::fitted(kind, task);
    identifier_.online = learn_limits(*identifier_.model, identifier_.targets, task.samples, {},
                                      identifier_.layout.dt);
    x_ = task.samples.x.topRows(5);
  }

  /// Refused as a model, or runs.
  void judge(const Container& file, const std::string& change) {
    const std::clock_t before = std::clock();
    try {
      const Identifier loaded = unpack(decode(encode(file), "m.dcnn"), "m.dcnn");
      ++accepted_;
      loaded.model->predict({x_, {}});
      const auto predictor = loaded.model->predictor();
      for (Index i = 0; i < x_.rows(); ++i) predictor->push(x_.row(i).transpose());
      const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
      StreamingFeatures(loaded.layout).push(zero, zero);
    } catch (const Error& error) {
      EXPECT_NE(error.exit(), Exit::kFailure) << change << ": " << error.what();
    } catch (const std::exception& error) {
      ADD_FAILURE() << change << ": " << error.what();
    }
    if (!test::kSanitized) {
      EXPECT_LT(double(std::clock() - before) / CLOCKS_PER_SEC, kMostSeconds) << change;
    }
    ++tried_;
  }

  Identifier identifier_;
  Eigen::MatrixXd x_;
  int tried_ = 0, accepted_ = 0;
};

TEST_P(HostileNumbers, AreRefusedOrBounded) {
  const Container whole = pack(identifier_);
  const MemoryLimit limit;
  for (const auto& [key, text] : whole.metadata) {
    if (text.empty() || text[0] != '{' || key == "configuration") continue;
    Container file = whole;
    Json json = Json::parse(text);
    each_wrong(json, key, [&, &part = file.metadata[key]](const std::string& change) {
      part = json.dump();
      judge(file, change);
    });
  }
  for (std::size_t k = 0; k < whole.tensors.size(); ++k) {
    Container file = whole;
    const auto fill = [&](double wrong) {
      std::visit(
          [&](auto& values) {
            using T = typename std::decay_t<decltype(values)>::value_type;
            for (T& v : values) v = static_cast<T>(std::min(wrong, 1e18));
          },
          file.tensors[k].values);
      judge(file, whole.tensors[k].name + " all " + std::to_string(wrong));
    };
    fill(0.0);
    fill(-1.0);
    fill(1e18);
  }
  EXPECT_GT(tried_, 100);
  EXPECT_GT(accepted_, 0) << "not all of them are refused for another reason";
}

/// 14 kB of model once took gigabytes (dt_s of a nanosecond).
TEST_P(HostileNumbers, OfTheClockAreRefused) {
  for (const double dt : {1e-9, 1e-7, -0.002, 1e5}) {
    Container file = pack(identifier_);
    Json features = Json::parse(file.metadata["features"]);
    features["dt_s"] = dt;
    file.metadata["features"] = features.dump();
    EXPECT_THROW(unpack(file, "m.dcnn"), Error) << dt;
  }
  Container file = pack(identifier_);
  Json features = Json::parse(file.metadata["features"]);
  features["dt_s"] = 1e-5;
  features["features"]["derivative"]["window_s"] = 100.0;
  file.metadata["features"] = features.dump();
  EXPECT_THROW(unpack(file, "m.dcnn"), Error);
}

INSTANTIATE_TEST_SUITE_P(Of, HostileNumbers,
                         testing::Values("rigid", "cf", "ffnn-s", "dcnn-plus", "lstm"),
                         [](const auto& entry) {
                           std::string name = entry.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace dcnn
