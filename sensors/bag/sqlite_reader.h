// This file reads the SQLite databases of rosbag2.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sensors/bag/recording_reader.h"

struct sqlite3;       // SQLite's
struct sqlite3_stmt;  // SQLite's

namespace maploop::sensors::bag {

constexpr std::string_view sqlite_magic = "SQLite format 3";

// Opens the database read-only and immutable: nothing is created beside it, and what is in its
// journal is not read, which is reported as damage. SQLite says which row is damaged, not where it
// is in the file: the offset is 0, or the size of the file if it was cut.
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

}  // namespace maploop::sensors::bag
