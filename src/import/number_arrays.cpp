// SPDX-License-Identifier: Apache-2.0
#include "import/number_arrays.h"

#include <functional>
#include <limits>
#include <map>

#include "import/units.h"

namespace dcnn {
namespace {

void add_stream_of(const std::vector<const NumberArray*>& arrays, const std::string& name,
                   LogBuilder& builder) {
  const std::size_t stream = builder.stream("arrays:" + name, [&] {
    LogStream made;
    made.name = name;
    made.type = "array";
    for (const NumberArray* array : arrays) {
      for (const std::string& channel_name : array->channels) {
        LogChannel channel;
        channel.name = channel_name;
        channel.unit = unit_of_name(channel_name);
        made.channels.push_back(std::move(channel));
      }
    }
    const auto& names = builder.options().text.columns;
    for (std::size_t k = 0; k < names.size() && names.size() == made.channels.size(); ++k) {
      made.channels[k].name = names[k];
    }
    return made;
  });
  constexpr double kNoStamp = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> row;
  for (Index k = 0; k < arrays[0]->rows; ++k) {
    row.clear();
    for (const NumberArray* array : arrays) {
      for (const auto& column : array->columns) row.push_back(column[static_cast<std::size_t>(k)]);
    }
    builder.add(stream, kNoStamp, kNoStamp, row);
  }
}

}  // namespace

std::string element_name(const std::string& array, Index column, Index columns) {
  return columns == 1 ? array : array + "[" + std::to_string(column) + "]";
}

std::vector<std::string> matrix_names(const std::string& array, Index order, bool by_columns) {
  std::vector<std::string> names;
  for (Index k = 0; k < order * order; ++k) {
    const Index row = by_columns ? k % order : k / order;
    const Index column = by_columns ? k / order : k % order;
    if (row == 3) {
      names.push_back(array + ".last.w" + std::to_string(column));
    } else if (column == 3) {
      names.push_back(array + ".position." + "xyz"[row]);
    } else {
      names.push_back(array + ".r" + std::to_string(row + 1) + std::to_string(column + 1));
    }
  }
  return names;
}

void add_number_arrays(const std::vector<NumberArray>& arrays, const std::string& name,
                       LogBuilder& builder) {
  std::map<Index, std::vector<const NumberArray*>, std::greater<>> by_length;
  for (const NumberArray& array : arrays) {
    if (array.rows > 1) by_length[array.rows].push_back(&array);
  }
  // Arrays of one length in two files are two streams: none goes on where the other ends.
  const std::string file = builder.file_prefix();
  int rank = 0;
  for (const auto& [rows, members] : by_length) {
    ++rank;
    add_stream_of(members, name.empty() ? file + "arrays" + std::to_string(rank) : name, builder);
  }
}

}  // namespace dcnn
