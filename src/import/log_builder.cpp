// SPDX-License-Identifier: Apache-2.0
#include "import/log_builder.h"

#include <cmath>

#include "data/text.h"
#include "dcnn/core/error.h"
#include "dcnn/core/excerpt.h"

namespace dcnn {
namespace {

constexpr std::size_t kMostStreams = 4096;
constexpr std::size_t kMostLogChannels = 200000;

}  // namespace

std::size_t LogBuilder::add_stream(const std::string& key, LogStream stream) {
  require(log_.streams.size() < kMostStreams, Exit::kData, log_.file, ": more than ", kMostStreams,
          " streams of numbers; cut the log to the topics of interest");
  std::size_t channels = stream.channels.size();
  for (const LogStream& other : log_.streams) channels += other.channels.size();
  require(channels <= kMostLogChannels, Exit::kData, log_.file, ": more than ", kMostLogChannels,
          " channels of numbers; cut the log to the topics of interest");
  if (stream.type == "text" || stream.type == "array") stream.source = stem_;
  // Names go to terminals and messages.
  constexpr std::size_t kLongestName = 200;
  for (std::string* name :
       {&stream.name, &stream.type, &stream.frame, &stream.child, &stream.source}) {
    *name = excerpt(*name, kLongestName);
  }
  for (LogChannel& channel : stream.channels) channel.name = excerpt(channel.name, kLongestName);
  std::vector<char> keep;
  for (const LogChannel& channel : stream.channels) {
    keep.push_back(!options_.wanted || options_.wanted(stream, channel.name));
  }
  keep_.push_back(std::move(keep));
  log_.streams.push_back(std::move(stream));
  return streams_[key] = log_.streams.size() - 1;
}

std::vector<std::string> LogBuilder::next_columns(std::size_t count) {
  const std::vector<std::string>& given = options_.text.columns;
  if (taken_ + count > given.size()) return {};
  const auto begin = given.begin() + static_cast<std::ptrdiff_t>(taken_);
  taken_ += count;
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

void LogBuilder::add(std::size_t index, double stamped, double received,
                     std::span<const double> row) {
  LogStream& stream = log_.streams[index];
  if (row.size() != stream.channels.size()) {  // words are made for a message only
    fail(Exit::kData, log_.file, ": rows of ", shown(stream.name), " have different lengths");
  }
  for (std::size_t k = 0; k < row.size(); ++k) stream.channels[k].add(row[k], keep_[index][k] != 0);
  if (!std::isnan(stamped)) stream.stamped.push_back(stamped);
  if (!std::isnan(received)) stream.received.push_back(received);
  ++stream.rows;
}

}  // namespace dcnn
