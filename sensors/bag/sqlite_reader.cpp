#include "sensors/bag/sqlite_reader.h"

#include <sqlite3.h>

#include <array>
#include <cctype>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "sensors/bag/whole_pages.h"

namespace maploop::sensors::bag {
namespace {

// Returns the file's name as SQLite's URI that opens it immutable.
std::string immutable_uri(const std::filesystem::path& path) {
  constexpr std::string_view digits = "0123456789abcdef", as_they_are = "/._-";
  std::string uri = "file:";
  for (const char c : path.string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || as_they_are.find(c) != std::string_view::npos) {
      uri += c;
    } else {
      uri += {'%', digits[byte >> 4U], digits[byte & 15U]};
    }
  }
  return uri + "?mode=ro&immutable=1";
}

std::string text_of(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text == nullptr
             ? ""
             : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
}

Bytes blob_of(sqlite3_stmt* row, int column) {
  const auto* blob = static_cast<const std::uint8_t*>(sqlite3_column_blob(row, column));
  return {blob, blob == nullptr ? 0 : static_cast<std::size_t>(sqlite3_column_bytes(row, column))};
}

Time time_of_column(sqlite3_stmt* row, int column) {
  return checked_time(static_cast<std::uint64_t>(sqlite3_column_int64(row, column)));
}

class SqliteReader final : public RecordingReader {
 public:
  // Throws FileError.
  explicit SqliteReader(const Opening& opening);

  std::optional<std::vector<TopicSummary>> index_summary() override;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

  bool read_more() override;

  void open(const std::filesystem::path& path);
  bool is_cut(const std::filesystem::path& path);
  void report_journals();
  void read_topics();
  std::map<std::string, std::string> read_definitions();
  void start_reading(bool cut);
  // Throws Malformed with SQLite's reason.
  Statement prepare(const std::string& sql);
  bool step(sqlite3_stmt* statement);

  std::unique_ptr<sqlite3, Close> database_;  // closed after the statements below
  std::map<std::int64_t, const Topic*> topics_;
  std::uint64_t steps_left_ = 0;  // of SQLite's machine, in thousands
  Statement ids_;                 // of the messages in their order
  std::pair<std::int64_t, std::int64_t> last_place_{INT64_MIN, INT64_MIN};  // in that order
  Statement row_;  // the message of an id, if it is selected
};

void SqliteReader::Close::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

void SqliteReader::Close::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

SqliteReader::SqliteReader(const Opening& opening) : RecordingReader(opening) {
  try {
    open(opening.path);
    const bool cut = is_cut(opening.path);
    read_topics();
    start_reading(cut);
  } catch (const Malformed& error) {
    throw FileError(file_, std::string("cannot be read as a database of rosbag2: ") + error.what());
  }
  report_journals();
}

// The content is not trusted: it can neither run code of triggers and views nor exceed the limits.
void SqliteReader::open(const std::filesystem::path& path) {
  sqlite3* database = nullptr;
  const int result = sqlite3_open_v2(
      immutable_uri(path).c_str(), &database,
      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_PRIVATECACHE,
      whole_pages());
  database_.reset(database);
  if (result != SQLITE_OK) throw Malformed(sqlite3_errstr(result));
  constexpr std::array off{SQLITE_DBCONFIG_TRUSTED_SCHEMA, SQLITE_DBCONFIG_ENABLE_TRIGGER,
                           SQLITE_DBCONFIG_ENABLE_VIEW};
  for (const int what : off) sqlite3_db_config(database, what, 0, nullptr);
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(input_limits::chunk));
  // A damaged tree can contain itself many times: SQLite's steps are limited. A message takes more
  // than a hundred bytes with its entry in the index, and some tens of steps.
  constexpr int steps_at_a_time = 1000;
  constexpr std::uint64_t least = 1000, bytes_each = 10;
  std::error_code unknown;
  steps_left_ = least + std::filesystem::file_size(path, unknown) / bytes_each;
  const auto count_steps = [](void* left) {
    auto& steps_left = *static_cast<std::uint64_t*>(left);
    return steps_left == 0 ? 1 : (--steps_left, 0);
  };
  sqlite3_progress_handler(database, steps_at_a_time, count_steps, &steps_left_);
  step(prepare("PRAGMA cell_size_check = ON").get());
}

// SQLite refuses a database that was cut, unless its schema is to be repaired.
bool SqliteReader::is_cut(const std::filesystem::path& path) {
  try {
    step(prepare("SELECT 1 FROM sqlite_master").get());
    return false;
  } catch (const Malformed&) {
    step(prepare("PRAGMA writable_schema = ON").get());
    step(prepare("SELECT 1 FROM sqlite_master").get());
  }
  std::error_code unknown;
  offset_ = std::filesystem::file_size(path, unknown);
  add_damage(offset_,
             "the database is cut or damaged: what is left is read in the order in which "
             "it was written");
  return true;
}

void SqliteReader::report_journals() {
  for (const char* ending : {"-wal", "-journal"}) {
    std::filesystem::path journal = file_;
    journal += ending;
    std::error_code missing;
    const auto size = std::filesystem::file_size(journal, missing);
    if (!missing && size > 0) {
      add_damage(0, "messages in " + journal.filename().string() +
                        " are not read: open the database once with sqlite3 to bring them back");
    }
  }
}

void SqliteReader::read_topics() {
  const auto definitions = read_definitions();
  const Statement rows = prepare("SELECT id, name, type, serialization_format FROM topics");
  while (step(rows.get())) {
    const std::string type = text_of(rows.get(), 2);
    const auto definition = definitions.find(type);
    topics_[sqlite3_column_int64(rows.get(), 0)] =
        add_topic({text_of(rows.get(), 1), ros1_type(type), text_of(rows.get(), 3),
                   definition == definitions.end() ? "" : definition->second});
  }
}

// Only databases of Iron and later have them.
std::map<std::string, std::string> SqliteReader::read_definitions() {
  std::map<std::string, std::string> definitions;
  const Statement table =
      prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'message_definitions'");
  if (!step(table.get())) return definitions;
  const Statement rows =
      prepare("SELECT topic_type, encoded_message_definition FROM message_definitions");
  std::size_t bytes = 0;
  while (step(rows.get())) {
    std::string text = text_of(rows.get(), 1);
    bytes += text.size();
    if (bytes > input_limits::table)
      throw Malformed("its types have more than " + std::to_string(input_limits::table) + " bytes");
    definitions.emplace(text_of(rows.get(), 0), std::move(text));
  }
  return definitions;
}

// Ids come from the index of times, so that a damaged message costs only itself. The pages of a cut
// database that are left are those that were written first.
void SqliteReader::start_reading(bool cut) {
  std::string selected;
  for (const auto& [id, topic] : topics_) {
    if (selects(*topic)) selected += (selected.empty() ? "" : ", ") + std::to_string(id);
  }
  const bool all = selection_.begin == Time::min();
  ids_ = prepare(cut ? "SELECT id, id FROM messages NOT INDEXED ORDER BY id"
                     : "SELECT id, timestamp FROM messages" +
                           std::string(all ? "" : " WHERE timestamp >= ?1") +
                           " ORDER BY timestamp, id");
  if (!cut && !all) sqlite3_bind_int64(ids_.get(), 1, to_nanoseconds(selection_.begin));
  row_ = prepare("SELECT topic_id, timestamp, data FROM messages WHERE id = ?1 AND topic_id IN (" +
                 selected + ")");
}

bool SqliteReader::read_more() {
  try {
    if (!step(ids_.get())) return false;
  } catch (const Malformed& error) {
    add_damage(offset_, std::string("no more messages can be read: ") + error.what());
    return false;
  }
  const std::int64_t id = sqlite3_column_int64(ids_.get(), 0);
  const std::pair<std::int64_t, std::int64_t> place(sqlite3_column_int64(ids_.get(), 1), id);
  if (place <= std::exchange(last_place_, place)) {
    add_damage(offset_, "no more messages can be read: they are not in order");
    return false;
  }
  try {
    sqlite3_reset(row_.get());
    sqlite3_bind_int64(row_.get(), 1, id);
    if (!step(row_.get())) return true;
    const Time received = time_of_column(row_.get(), 1);
    const auto topic = topics_.find(sqlite3_column_int64(row_.get(), 0));
    if (topic != topics_.end() && received >= selection_.begin)
      waiting_.push_back({received, topic->second, blob_of(row_.get(), 2)});
  } catch (const Malformed& error) {
    throw Malformed("message " + std::to_string(id) + " is left out: " + error.what());
  }
  return true;
}

std::optional<std::vector<TopicSummary>> SqliteReader::index_summary() {
  std::vector<TopicSummary> topics;
  try {
    const Statement rows = prepare(
        "SELECT topic_id, count(*), min(timestamp), max(timestamp) FROM messages "
        "GROUP BY topic_id");
    std::map<std::int64_t, TopicSummary> found;
    for (const auto& [id, topic] : topics_) found[id].topic = *topic;
    while (step(rows.get())) {
      const auto topic = found.find(sqlite3_column_int64(rows.get(), 0));
      if (topic == found.end()) continue;
      topic->second.messages = static_cast<std::uint64_t>(sqlite3_column_int64(rows.get(), 1));
      topic->second.first = time_of_column(rows.get(), 2);
      topic->second.last = time_of_column(rows.get(), 3);
      if (topic->second.last < topic->second.first) throw Malformed("times that are no numbers");
    }
    for (auto& [id, topic] : found) topics.push_back(std::move(topic));
  } catch (const Malformed&) {
    return {};  // reading it through finds what is left
  }
  return topics;
}

SqliteReader::Statement SqliteReader::prepare(const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  const int result = sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr);
  if (result != SQLITE_OK) throw Malformed(sqlite3_errmsg(database_.get()));
  return Statement(statement);
}

bool SqliteReader::step(sqlite3_stmt* statement) {
  const int result = sqlite3_step(statement);
  if (result != SQLITE_ROW && result != SQLITE_DONE)
    throw Malformed(sqlite3_errmsg(database_.get()));
  return result == SQLITE_ROW;
}

}  // namespace

std::unique_ptr<RecordingReader> open_sqlite(const Opening& opening) {
  return std::make_unique<SqliteReader>(opening);
}

}  // namespace maploop::sensors::bag
