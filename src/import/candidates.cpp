#include "import/candidates.h"

#include <algorithm>

#include "data/text.h"
#include "import/roles.h"

namespace dcnn {
namespace {

std::size_t common_beginning(const std::string& a, const std::string& b) {
  const auto ends = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<std::size_t>(ends.first - a.begin());
}

}  // namespace

std::optional<std::size_t> nearest_to_said(const std::vector<std::string>& candidates,
                                           const std::vector<std::string>& said) {
  std::optional<std::size_t> nearest;
  std::size_t longest = 0;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    std::size_t length = 0;
    for (const std::string& name : said) {
      length = std::max(length, common_beginning(candidates[k], name));
    }
    if (length == longest) nearest.reset();
    if (length > longest) longest = length, nearest = k;
  }
  return nearest;
}

std::string question_between(const std::string& column, const std::string& stream,
                             const std::vector<std::string>& candidates) {
  return "both " + shown(stream + ":" + candidates[0]) + " and " +
         shown(stream + ":" + candidates[1]) + " may be " + column + ": say --map " + column +
         "=…; columns of the same beginning follow";
}

bool is_trajectory(const LogStream& stream) {
  bool translation = false, other = false;
  for (const LogChannel& channel : stream.channels) {
    const std::string role = role_of(stream, channel.name);
    translation = translation || role == "tx";
    other = other || role == "fx" || role == "x";
  }
  return translation && !other;
}

}  // namespace dcnn
