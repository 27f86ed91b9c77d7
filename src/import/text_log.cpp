// SPDX-License-Identifier: Apache-2.0
#include "import/text_log.h"

#include <cmath>

#include "data/line_reader.h"
#include "data/text.h"
#include "dcnn/core/error.h"
#include "import/list_cells.h"
#include "import/text_cells.h"
#include "import/text_layout.h"
#include "import/units.h"

namespace dcnn {
namespace {

constexpr std::size_t kSampleLines = 400;
constexpr std::size_t kSampleBytes = std::size_t{1} << 22;

/// The first line without its byte order mark; other encodings are refused.
void check_text(std::string_view* line, bool first, const std::string& place) {
  if (first) {
    if (line->substr(0, 3) == "\xEF\xBB\xBF") line->remove_prefix(3);
    require(line->substr(0, 2) != "\xFF\xFE" && line->substr(0, 2) != "\xFE\xFF", Exit::kData,
            place, ": is UTF-16 text; convert it: iconv -f UTF-16 -t UTF-8 FILE");
  }
  require(line->find('\0') == std::string_view::npos, Exit::kData, place,
          ": contains a NUL byte: is neither text nor a known format of logs");
}

/// Lines of a text, those joined over which a list goes on.
class ListLines {
 public:
  explicit ListLines(LineReader& reader) : reader_(reader) {}

  /// Valid until the next call; false at the end.
  bool next(std::string_view* line) {
    if (!take(line)) return false;
    number_ = reader_.number();
    if (line->find('[') == std::string_view::npos || is_aside(*line)) return true;
    std::size_t open = ListCells::open_from(*line);
    if (open == std::string_view::npos) return true;
    joined_ = *line;
    while (open != std::string_view::npos) {
      std::string_view more;
      require(joined_.size() < kLongestRow && take(&more), Exit::kData, reader_.place(number_),
              ": a list that begins here has no end");
      joined_ += '\n';
      joined_ += more;
      // Without a bracket it goes on; what is before it has been read.
      const bool is_short = joined_.size() - open < ListCells::kLongest;
      if (is_short && more.find(']') == std::string_view::npos) continue;
      open = ListCells::open_from(joined_, open);
    }
    *line = joined_;
    return true;
  }
  /// Of the line last given, where it begins.
  Index number() const { return number_; }

 private:
  static constexpr std::size_t kLongestRow = std::size_t{1} << 20;  // bytes

  bool take(std::string_view* line) {
    if (!reader_.next(line)) return false;
    check_text(line, reader_.number() == 1, reader_.place());
    return true;
  }

  LineReader& reader_;
  std::string joined_;
  Index number_ = 0;
};

/// Reads rows after the layout is known.
class TextRows {
 public:
  TextRows(const TextLayout& layout, LogBuilder& builder, const std::string& stem)
      : layout_(layout), builder_(builder) {
    stream_ = builder.stream("text:" + stem, [&] { return describe(stem); });
  }

  void add(std::string_view line, const LineReader& reader, Index number) {
    if (number < layout_.first_row || is_aside(line)) return;
    fail_cut();
    split_cells(line, layout_.separator, &cells_);
    const std::size_t wanted = layout_.names.size();
    if (cells_.size() == wanted + 1 && bare(cells_.back()).empty()) cells_.pop_back();
    if (cells_.size() != wanted) {
      // Only the last line of a log that was cut off may be short; it is known by what follows.
      cut_ = reader.place(number) + ": " + std::to_string(cells_.size()) +
             " cells where there are " + std::to_string(wanted) + " columns" +
             (cells_.size() + 1 >= 2 * wanted ? "; decimal commas? see --decimal and --separator"
                                              : "; repair or remove this row");
      return;
    }
    row_.clear();
    for (std::size_t k = 0; k < wanted; ++k) {
      if (layout_.numeric[k] == 0) continue;
      double value = 0.0;
      const CellKind kind = read_cell(cells_[k], layout_.decimal, &value);
      require(kind != CellKind::kText, Exit::kData, reader.place(number), ": column ",
              shown(layout_.names[k]), " is not a number: ", shown(bare(cells_[k])),
              "; correct or remove the row");
      row_.push_back(value);
    }
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    builder_.add(stream_, kNone, kNone, row_);
  }

  void finish(const std::string& file) {
    if (!cut_.empty()) builder_.log().notes.push_back("the last row is cut off: left out");
    require(builder_.log().streams[stream_].rows > 0, Exit::kData, file, ": holds no rows");
  }

 private:
  void fail_cut() const {
    if (!cut_.empty()) fail(Exit::kData, cut_);
  }

  LogStream describe(const std::string& stem) const {
    LogStream stream;
    stream.name = stem;
    stream.type = "text";
    for (std::size_t k = 0; k < layout_.names.size(); ++k) {
      if (layout_.numeric[k] == 0) continue;
      LogChannel channel;
      channel.name = layout_.names[k];
      channel.unit = layout_.units.empty() ? unit_of_name(channel.name) : layout_.units[k];
      stream.channels.push_back(std::move(channel));
    }
    return stream;
  }

  const TextLayout& layout_;
  LogBuilder& builder_;
  std::size_t stream_ = 0;
  std::vector<std::string_view> cells_;
  std::vector<double> row_;
  std::string cut_;
};

}  // namespace

void read_text_log(const std::filesystem::path& path, const std::string& name,
                   LogBuilder& builder) {
  LineReader reader(path);
  ListLines lines(reader);
  std::vector<std::string> sample;
  std::vector<Index> numbers;
  std::string_view line;
  std::size_t bytes = 0, judged = 0;  // a file may begin with any number of comments
  while (judged < kSampleLines && bytes < kSampleBytes && lines.next(&line)) {
    bytes += line.size();
    judged += !is_aside(line);
    sample.emplace_back(line);
    numbers.push_back(lines.number());
  }
  require(!sample.empty(), Exit::kData, reader.name(), ": is empty");
  const ListCells lists(sample);
  if (lists.found()) {
    for (std::string& early : sample) early = lists.spread(early);
  }
  TextLayout layout = find_layout(sample, builder.options().text, reader.name(),
                                  [&](std::size_t count) { return builder.next_columns(count); });
  layout.first_row = numbers[static_cast<std::size_t>(layout.first_row - 1)];
  ForeignLog& log = builder.log();
  log.format = layout.words();
  log.notes.insert(log.notes.end(), layout.notes.begin(), layout.notes.end());
  TextRows rows(layout, builder, name);
  for (std::size_t k = 0; k < sample.size(); ++k) rows.add(sample[k], reader, numbers[k]);
  std::string spread;
  while (lines.next(&line)) {
    if (lists.found()) line = spread = lists.spread(line);
    rows.add(line, reader, lines.number());
  }
  rows.finish(reader.name());
}

}  // namespace dcnn
