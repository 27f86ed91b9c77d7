// SPDX-License-Identifier: Apache-2.0
#include "dcnn/conceal/faulty.h"

#include "conceal/faulty_alter.h"

namespace dcnn::conceal {
namespace {

const FaultyKind& faulty_kind(const std::string& name) {
  for (const auto* kinds : {&faults_of_meaning(), &faults_of_rows(), &faults_of_arms()}) {
    for (const FaultyKind& kind : *kinds) {
      if (kind.name == name) return kind;
    }
  }
  fail(Exit::kUsage, "no faulty log is called '", name, "'; see dcnn-conceal --help");
}

std::uint64_t stream_of(const std::string& name) {
  std::uint64_t hash = 17;
  for (const char c : name) hash = mix_bits(hash ^ static_cast<unsigned char>(c));
  return hash;
}

}  // namespace

std::vector<std::string> faulty_kinds() {
  std::vector<std::string> names;
  for (const auto* kinds : {&faults_of_meaning(), &faults_of_rows(), &faults_of_arms()}) {
    for (const FaultyKind& kind : *kinds) names.emplace_back(kind.name);
  }
  return names;
}

FaultyLog make_faulty(const std::string& name, std::uint64_t seed) {
  const FaultyKind& kind = faulty_kind(name);
  Rng rng({seed, stream_of(name)});
  FaultyLog log = make_clean(kind.clean, rng);
  kind.alter(log.table, rng);
  log.fault = kind.fault;
  return log;
}

Table with_fault(const std::string& name, Table log, std::uint64_t seed) {
  Rng rng({seed, stream_of(name), 1});
  faulty_kind(name).alter(log, rng);
  return log;
}

}  // namespace dcnn::conceal
