// SPDX-License-Identifier: Apache-2.0
#include "support/import_flags.h"

#include <charconv>

namespace dcnn {
namespace {

/// "fx,fy=mN" as {fx: mN, fy: mN}.
std::map<std::string, std::string> pairs_of(const std::vector<std::string>& words,
                                            const char* option) {
  std::map<std::string, std::string> pairs;
  for (const std::string& word : words) {
    const std::size_t at = word.find('=');
    require(at != std::string::npos && at > 0 && at + 1 < word.size(), Exit::kUsage, option, " ",
            word, ": write NAME=VALUE");
    std::istringstream names(word.substr(0, at));
    for (std::string name; std::getline(names, name, ',');) pairs[name] = word.substr(at + 1);
  }
  return pairs;
}

std::map<std::string, double> numbers_of(const std::vector<std::string>& words,
                                         const char* option) {
  std::map<std::string, double> numbers;
  for (const auto& [name, text] : pairs_of(words, option)) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    require(error == std::errc() && end == text.data() + text.size(), Exit::kUsage, option, " ",
            name, "=", text, ": is no number");
    numbers[name] = value;
  }
  return numbers;
}

Eigen::Vector3d vector_of(const std::vector<double>& list) {
  return list.empty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(list[0], list[1], list[2]);
}

constexpr const char* kText = "Text";
constexpr const char* kChannels = "Channels";
constexpr const char* kClocks = "Clocks";
constexpr const char* kFrames = "Frames";

}  // namespace

ImportFlags::ImportFlags(Tool& tool, const Option& recipe) {
  for (const auto& add :
       {&ImportFlags::text, &ImportFlags::channels, &ImportFlags::clocks, &ImportFlags::frames}) {
    for (const Option& option : (this->*add)(tool)) option.excludes(recipe);
  }
  tool.flag("--truncated", truncated_, "take what is whole of a log that ends in the middle")
      .group(kText);
}

std::vector<Option> ImportFlags::text(Tool& tool) {
  return {tool.option("--columns", columns_, "names of the columns of a text without a header")
              .separated_by_commas()
              .group(kText),
          tool.option("--separator", separator_, "what separates columns (else found)")
              .one_of({",", ";", "|", "tab", "space"})
              .group(kText),
          tool.option("--decimal", decimal_, "decimal mark (else found)")
              .one_of({".", ","})
              .group(kText)};
}

std::vector<Option> ImportFlags::channels(Tool& tool) {
  return {
      tool.option("--use", use_, "topics or variables to take, where several would do")
          .group(kChannels),
      tool.option("--map", map_, "COLUMN=CHANNEL: fx=Fz_raw, or x=/pose:pose.position.x")
          .group(kChannels),
      tool.option("--also", also_, "channels to keep under their own names").group(kChannels),
      tool.option("--unit", units_, "COLUMN,…=UNIT: fx,fy,fz=mN, alpha,beta,gamma=deg")
          .group(kChannels),
      tool.option("--gain", gains_, "COLUMN,…=FACTOR before the unit: counts, turned signs (-1)")
          .group(kChannels),
      tool.option("--offset", offsets_, "COLUMN,…=NUMBER taken from the raw value")
          .group(kChannels),
      tool.option("--wrap", wraps_, "COLUMN,…=COUNTS after which a register begins anew: 65536")
          .group(kChannels)};
}

std::vector<Option> ImportFlags::clocks(Tool& tool) {
  return {
      tool.option("--clock", clock_, "channel of the time, one for each stream (else found)")
          .group(kClocks),
      tool.option("--clock-unit", clock_unit_, "its unit")
          .one_of({"s", "ms", "us", "ns"})
          .group(kClocks),
      tool.option("--rate", rate_hz_, "rows per second of a log without times [Hz]")
          .positive()
          .group(kClocks),
      tool.option("--stamps", stamps_, "times of messages: in their headers, or of their receipt")
          .one_of({"header", "receive"})
          .with_default()
          .group(kClocks),
      tool.option("--clock-offset", clock_offsets_,
                  "STREAM=SECONDS to add to its times; auto: as estimated from the motion")
          .group(kClocks)};
}

std::vector<Option> ImportFlags::frames(Tool& tool) {
  return {
      tool.option("--quaternion-order", quaternion_order_, "of a quaternion given by index")
          .one_of({"wxyz", "xyzw"})
          .group(kFrames),
      tool.option("--euler-order", euler_order_,
                  "turns of three angles: ZYX about moving axes, xyz about fixed ones, any other")
          .group(kFrames),
      tool.flag("--inverse-pose", inverse_, "the log has the pose of the base in the tool")
          .group(kFrames),
      tool.option(
              "--wrench-frame", wrench_frame_,
              "frame of the logged wrench; auto: the sensor's, but where the robot's maker says "
              "another")
          .one_of({"auto", "sensor", "base"})
          .with_default()
          .group(kFrames),
      tool.option("--wrench-turn", turn_, "logged frame in the sensor's: rx ry rz [rad]")
          .values(3, "numbers rx ry rz [rad]")
          .group(kFrames),
      tool.option("--wrench-origin", origin_, "logged origin in the sensor's frame: x y z [m]")
          .values(3, "numbers x y z [m]")
          .group(kFrames),
      tool.flag("--zeroed", zeroed_, "the sensor was set to zero when each recording began")
          .group(kFrames),
      tool.option("--payload", payload_,
                  "KG [X Y Z]: mass and centre [m] of a body whose weight the robot's controller "
                  "has subtracted from the force; it is added back")
          .group(kFrames),
      tool.option("--urdf", urdf_, "robot description: joint angles become the pose of --link")
          .called("FILE")
          .group(kFrames),
      tool.option("--link", link_, "link that carries the sensor").group(kFrames),
      tool.option("--base-link", base_link_, "link that is the base (else the root)")
          .group(kFrames)};
}

ReadLogOptions ImportFlags::read() const {
  ReadLogOptions options;
  options.text = {separator_, decimal_, columns_};
  options.accept_truncated = truncated_;
  return options;
}

ImportWishes ImportFlags::wishes() const {
  ImportWishes wishes;
  wishes.use = use_;
  wishes.map = pairs_of(map_, "--map");
  wishes.units = pairs_of(units_, "--unit");
  wishes.gains = numbers_of(gains_, "--gain");
  wishes.offsets = numbers_of(offsets_, "--offset");
  wishes.wraps = numbers_of(wraps_, "--wrap");
  std::vector<std::string> said;
  for (const std::string& word : clock_offsets_) {
    if (!word.ends_with("=auto")) said.push_back(word);
  }
  wishes.clock_offsets = numbers_of(said, "--clock-offset");
  wishes.clock = clock_;
  wishes.clock_unit = clock_unit_;
  wishes.stamps = stamps_;
  wishes.rate_hz = rate_hz_;
  wishes.quaternion_order = quaternion_order_;
  wishes.euler_order = euler_order_;
  wishes.also = also_;
  wishes.orientation.inverse = inverse_;
  wishes.wrench = {wrench_frame_, vector_of(turn_), vector_of(origin_), zeroed_,
                   payload_of(payload_)};
  wishes.arm = {urdf_, base_link_, link_};
  require(urdf_.empty() == link_.empty(), Exit::kUsage,
          "--urdf makes the pose of --link from joint angles: say both; an arm's own torques need "
          "neither here: give the URDF to dcnn-diagnose and dcnn-identify");
  return wishes;
}

std::vector<std::string> ImportFlags::estimated_offsets() const {
  constexpr std::size_t kEnding = 5;  // "=auto"
  std::vector<std::string> streams;
  for (const std::string& word : clock_offsets_) {
    if (word.ends_with("=auto")) streams.push_back(word.substr(0, word.size() - kEnding));
  }
  return streams;
}

}  // namespace dcnn
