// SPDX-License-Identifier: Apache-2.0
#include "peers/serve.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <iostream>
#include <sstream>

#include "dcnn/core/file.h"
#include "experiment/peers/child.h"

namespace dcnn::peers {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

ExportedNetwork read_network(const std::string& path) {
  ExportedNetwork network;
  network.file = read_container(path);
  network.layers = Json::parse(network.file.metadata.at("layers"));
  network.input = Json::parse(network.file.metadata.at("input")).get<Shape>();
  network.carries = Json::parse(network.file.metadata.at("carries")).get<bool>();
  return network;
}

std::vector<float> read_samples(const std::string& path) {
  const std::string bytes = read_file(path, std::size_t{1} << 32, Exit::kData);
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

class Session {
 public:
  explicit Session(const Library& library) : library_(library) {}

  Json answer(std::istringstream& line) {
    std::string verb;
    line >> verb;
    if (verb == "load") return load(line);
    if (verb == "outputs") return outputs(read<Index>(line));
    if (verb == "run") return run(read<Index>(line));
    if (verb == "each") return each(read<Index>(line));
    if (verb == "task") return task(line);
    if (verb == "epoch" && trainee_) return timed([&] { trainee_->epoch(); });
    fail(Exit::kUsage, "cannot do '", verb, "' now");
  }

 private:
  template <class T>
  static T read(std::istringstream& line) {
    T value{};
    require(bool(line >> value), Exit::kUsage, "a number or a path is missing");
    return value;
  }

  template <class Work>
  static Json timed(const Work& work) {
    const auto begin = Clock::now();
    work();
    return {{"seconds", seconds_since(begin)}};
  }

  Json load(std::istringstream& line) {
    batch_ = read<Index>(line);
    const int threads = read<int>(line);
    std::string samples, network;
    line >> samples >> network;
    const ExportedNetwork exported = read_network(network);
    samples_ = read_samples(samples);
    call_size_ = batch_ * element_count(exported.input);
    calls_ = std::min<Index>(kMostDistinctCalls, static_cast<Index>(samples_.size()) / call_size_);
    require(calls_ > 0, Exit::kData, samples, ": fewer samples than one call takes");
    runner_ = library_.load(exported, batch_, threads);
    return {{"outputs", runner_->outputs()}};
  }

  const float* call(Index k) {
    if (k % calls_ == 0) runner_->begin();
    return runner_->run(samples_.data() + k % calls_ * call_size_);
  }

  Json outputs(Index count) {
    std::vector<double> values;
    for (Index first = 0; first < count; first += batch_) {
      const float* y = call(first / batch_);
      const Index rows = std::min(batch_, count - first);
      values.insert(values.end(), y, y + rows * runner_->outputs());
    }
    return {{"values", values}};
  }

  Json run(Index calls) {
    return timed([&] {
      for (Index k = 0; k < calls; ++k) call(k);
    });
  }

  Json each(Index calls) {
    std::vector<double> seconds;
    seconds.reserve(static_cast<std::size_t>(calls));
    for (Index k = 0; k < calls; ++k) {
      const auto begin = Clock::now();
      call(k);
      seconds.push_back(seconds_since(begin));
    }
    return {{"seconds", seconds}};
  }

  Json task(std::istringstream& line) {
    require(bool(library_.train), Exit::kUsage, "this library trains nothing");
    const auto network = read<std::string>(line);
    trainee_ = library_.train(network, read<int>(line));
    return Json::object();
  }

  const Library& library_;
  std::vector<float> samples_;
  Index batch_ = 1, call_size_ = 1, calls_ = 1;
  std::unique_ptr<Runner> runner_;
  std::unique_ptr<Trainee> trainee_;
};

}  // namespace

const StoredTensor& ExportedNetwork::tensor(Index layer, const std::string& name) const {
  const auto kind = layers[layer].at("kind").get<std::string>();
  const StoredTensor* found = file.find(std::to_string(layer) + "." + kind + "." + name);
  require(found != nullptr, Exit::kModel, "layer ", layer, " has no '", name, "'");
  return *found;
}

const float* ExportedNetwork::values(Index layer, const std::string& name) const {
  return std::get<std::vector<float>>(tensor(layer, name).values).data();
}

int serve(const Library& library) {
  std::cout << Json{{"name", library.name},
                    {"version", library.version},
                    {"trains", bool(library.train)}}
                   .dump()
            << std::endl;
  Session session(library);
  for (std::string text; std::getline(std::cin, text);) {
    Json answer;
    try {
      std::istringstream line(text);
      answer = session.answer(line);
    } catch (const std::exception& error) {
      answer = {{"error", error.what()}};
    }
    std::cout << answer.dump() << std::endl;
  }
  return 0;
}

}  // namespace dcnn::peers
