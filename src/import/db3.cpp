// SPDX-License-Identifier: Apache-2.0
#include "data/text.h"
#include "dcnn/core/error.h"
#include "import/message_topics.h"
#include "import/readers.h"

#ifdef DCNN_WITH_SQLITE
#include <sqlite3.h>
#endif

namespace dcnn {

#ifdef DCNN_WITH_SQLITE
namespace {

constexpr int kMostBlob = 64 << 20;
constexpr int kStepsPerLook = 10000;  // of SQLite's machine between two looks at the budget
constexpr std::uint64_t kLooksPerRow = 1000;

/// A database opened as data of others: read-only, no code of its schema trusted.
class Database {
 public:
  explicit Database(const std::filesystem::path& path) : name_(path.string()) {
    const int state = sqlite3_open_v2(path.c_str(), &db_, SQLITE_OPEN_READONLY, nullptr);
    if (state != SQLITE_OK) fail_here("cannot be opened");
    sqlite3_db_config(db_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(db_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_limit(db_, SQLITE_LIMIT_LENGTH, kMostBlob);
    sqlite3_limit(db_, SQLITE_LIMIT_ATTACHED, 0);
    sqlite3_progress_handler(db_, kStepsPerLook, &Database::look, this);
  }
  ~Database() { sqlite3_close_v2(db_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  [[noreturn]] void fail_here(const char* what) const {
    fail(Exit::kData, name_, ": ", what, ": ", db_ != nullptr ? sqlite3_errmsg(db_) : "no memory",
         "; is it a .db3 of rosbag2?");
  }
  sqlite3* get() const { return db_; }
  void refill() { looks_ = 0; }
  const std::string& name() const { return name_; }

 private:
  /// Ends a query that computes without giving rows.
  static int look(void* self) {
    return ++static_cast<Database*>(self)->looks_ > kLooksPerRow ? 1 : 0;
  }

  std::string name_;
  sqlite3* db_ = nullptr;
  std::uint64_t looks_ = 0;
};

class Query {
 public:
  Query(Database& database, const std::string& text) : database_(database) {
    if (sqlite3_prepare_v2(database.get(), text.c_str(), -1, &statement_, nullptr) != SQLITE_OK) {
      database.fail_here("has not the tables of a bag");
    }
  }
  ~Query() { sqlite3_finalize(statement_); }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  bool next() {
    database_.refill();
    const int state = sqlite3_step(statement_);
    if (state != SQLITE_ROW && state != SQLITE_DONE) database_.fail_here("is damaged");
    return state == SQLITE_ROW;
  }
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
  std::string_view bytes(int column) const {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_, column));
    const int size = sqlite3_column_bytes(statement_, column);
    return data == nullptr ? std::string_view()
                           : std::string_view(data, static_cast<std::size_t>(size));
  }

 private:
  Database& database_;
  sqlite3_stmt* statement_ = nullptr;
};

/// Whether a table (not a view, which could be any computation) has this name.
bool has_table(Database& database, const std::string& name) {
  Query query(database,
              "SELECT count(*) FROM sqlite_schema WHERE type='table' AND name='" + name + "'");
  return query.next() && query.integer(0) == 1;
}

std::map<std::string, std::string> definitions_in(Database& database) {
  std::map<std::string, std::string> definitions;
  if (!has_table(database, "message_definitions")) return definitions;
  Query query(database,
              "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
  while (query.next()) {
    if (query.bytes(1) == "ros2msg") {
      definitions[std::string(query.bytes(0))] = query.bytes(2);
    }
  }
  return definitions;
}

}  // namespace

void read_db3(const std::filesystem::path& path, LogBuilder& builder) {
  Database database(path);
  for (const char* table : {"topics", "messages"}) {
    require(has_table(database, table), Exit::kData, path.string(), ": has no table ", table,
            "; is it a .db3 of rosbag2?");
  }
  MessageTopics topics(builder, path.string());
  const auto definitions = definitions_in(database);
  Query list(database, "SELECT id, name, type, serialization_format FROM topics");
  while (list.next()) {
    const std::string type(list.bytes(2));
    const auto found = definitions.find(type);
    topics.add(static_cast<std::uint32_t>(list.integer(0)), std::string(list.bytes(1)), type,
               std::string(list.bytes(3)), found == definitions.end() ? "" : found->second);
  }
  Query messages(database, "SELECT topic_id, timestamp, data FROM messages ORDER BY rowid");
  while (messages.next()) {
    topics.message(static_cast<std::uint32_t>(messages.integer(0)),
                   1e-9 * static_cast<double>(messages.integer(1)), messages.bytes(2));
  }
  topics.finish();
  builder.log().format = "rosbag2 (SQLite)";
}

#else

void read_db3(const std::filesystem::path& path, LogBuilder&) {
  fail(Exit::kData, path.string(),
       ": is a bag in SQLite, which this build was made without; "
       "install libsqlite3-dev and build again");
}

#endif

}  // namespace dcnn
