// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/table_reader.h"

#include <utility>

namespace dcnn {
namespace {

TableReader& chosen_table_reader() {
  static TableReader reader;
  return reader;
}

}  // namespace

void set_table_reader(TableReader reader) { chosen_table_reader() = std::move(reader); }

SourceTable read_table(const std::filesystem::path& path) {
  const TableReader& reader = chosen_table_reader();
  return reader ? reader(path) : SourceTable{read_csv(path), {}};
}

}  // namespace dcnn
