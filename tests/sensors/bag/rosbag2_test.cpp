// Folders and databases of rosbag2.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <zstd.h>

#include <cstdlib>

#include "msgs/input_file.h"
#include "tests/sensors/bag/bag_contents.h"
#include "tests/support/error_of.h"

namespace maploop::sensors {
namespace {

using testing::bytes_of;
using ::testing::HasSubstr;
using testing::kitti_bag;
using testing::read_bag;
using testing::recorded_bag;
using testing::write_bytes;

std::string zstd(const std::string& plain) {
  std::string packed(ZSTD_compressBound(plain.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), 1));
  return packed;
}

class Rosbag2 : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    return write_bytes(folder_.path() / name, bytes);
  }
  // A database with messages 1, 2, ... at 10, 20, ... ns, all of the topic /a. Returns its name.
  std::filesystem::path database(const std::string& name, int messages,
                                 const std::string& more_sql = "") const {
    auto file = folder_.path() / name;
    sqlite3* db = nullptr;
    EXPECT_EQ(sqlite3_open(file.c_str(), &db), SQLITE_OK);
    std::string sql =
        "PRAGMA synchronous = OFF; BEGIN;"
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp "
        "INTEGER "
        "NOT NULL, data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages(timestamp ASC);"
        "INSERT INTO topics VALUES(1, '/a', 'my_msgs/msg/A', 'cdr', '');";
    for (int i = 1; i <= messages; ++i) {
      sql += "INSERT INTO messages VALUES(" + std::to_string(i) + ", 1, " + std::to_string(10 * i) +
             ", x'000100000" + std::to_string(i % 10) + "');";
    }
    sql += more_sql + "COMMIT;";
    char* error = nullptr;
    EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, &error), SQLITE_OK) << error;
    sqlite3_close(db);
    return file;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Rosbag2, OrdersMessagesByTimeAndKnowsTheirDefinition) {
  const auto file = database(
      "defined.db3", 3,
      "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding "
      "TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, type_description_hash TEXT);"
      "INSERT INTO message_definitions VALUES(1, 'my_msgs/msg/A', 'ros2msg', 'int8 x', '');"
      "INSERT INTO messages VALUES(9, 1, 15, x'0001000009');"
      "INSERT INTO messages VALUES(10, 77, 16, x'00');");
  const auto contents = read_bag(file);
  EXPECT_TRUE(contents.damage.empty());
  std::string last;
  for (const auto& m : contents.messages) last += static_cast<char>('0' + m.data.back());
  EXPECT_EQ(last, "1923");
  EXPECT_EQ(contents.topics.at("/a").type, "my_msgs/A");
  EXPECT_EQ(contents.topics.at("/a").definition, "int8 x");
  EXPECT_EQ(summarize(file).topics.at(0).messages, 4U);
}

TEST_F(Rosbag2, IsDecompressedIntoFilesThatDoNotStay) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const testing::TemporaryFolder temporary;
  setenv("TMPDIR", temporary.path().c_str(), 1);
  const std::string plain = bytes_of(recorded_bag("pj_rosbag2_test_0.db3"));
  write("pj_0.db3.zstd", zstd(plain));
  write("metadata.yaml",
        "rosbag2_bagfile_information:\n  relative_file_paths:\n    - pj/pj_0.db3.zstd\n"
        "  compression_format: zstd\n  compression_mode: FILE\n");
  const auto expected = read_bag(recorded_bag("pj_rosbag2_test_0.db3")).messages;
  EXPECT_TRUE(is_bag(folder_.path()));
  const auto reader = open_messages(folder_.path(), {});
  EXPECT_EQ(reader->next(), MessageReader::Item::message);
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path()));
  EXPECT_EQ(read_bag(folder_.path()).messages, expected);

  const auto mcap = kitti_bag("kitti13_zstd.mcap");
  EXPECT_EQ(read_bag(write("b.mcap.zstd", zstd(bytes_of(mcap)))).messages, read_bag(mcap).messages);
  EXPECT_EQ(read_bag(write("c.mcap.gz", gzip(bytes_of(mcap)))).messages, read_bag(mcap).messages);
  const auto cut = write("cut.db3.zstd", zstd(plain).substr(0, 100'000));
  EXPECT_THAT(testing::error_of([&] { open_messages(cut, {}); }), HasSubstr("damaged or cut"));
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path()));
  unsetenv("TMPDIR");
}

TEST_F(Rosbag2, HasSeveralFiles) {
  database("split_0.db3", 1);
  database("split_2.db3", 2);
  database("split_10.db3", 3);
  write("metadata.yaml.off", "");
  // Without metadata.yaml, which rosbag2 writes at the end: in the natural order of the names.
  EXPECT_EQ(read_bag(folder_.path()).messages.size(), 6U);
  const auto reader = open_messages(folder_.path(), {});
  ASSERT_EQ(reader->next(), MessageReader::Item::message);
  const Topic* const first = reader->message().topic;
  ASSERT_EQ(reader->next(), MessageReader::Item::message);
  EXPECT_EQ(reader->message().topic, first);  // one topic in all files
  ASSERT_EQ(reader->next(), MessageReader::Item::message);
  EXPECT_EQ(reader->message().received, from_nanoseconds(20));  // of split_2
  // With it: those that it names, and a missing one is damage.
  write("metadata.yaml",
        "rosbag2_bagfile_information:\n  relative_file_paths:\n  - split_10.db3\n"
        "  - \"lost_1.db3\"\n  - split_0.db3\n  storage_identifier: sqlite3\n");
  const auto named = read_bag(folder_.path());
  EXPECT_EQ(named.messages.size(), 4U);
  ASSERT_EQ(named.damage.size(), 1U);
  EXPECT_EQ(named.damage[0].file.filename(), "lost_1.db3");
  const BagSummary summary = summarize(folder_.path());
  ASSERT_EQ(summary.topics.size(), 1U);
  EXPECT_EQ(summary.topics[0].messages, 4U);
  EXPECT_EQ(summary.topics[0].first, from_nanoseconds(10));
  EXPECT_EQ(summary.topics[0].last, from_nanoseconds(30));
  EXPECT_EQ(summary.damage.size(), 1U);
  write("metadata.yaml", "compression_format: lzma\n");
  EXPECT_THAT(testing::error_of([&] { open_messages(folder_.path(), {}); }),
              HasSubstr("'lzma' is not known"));
}

TEST_F(Rosbag2, LosesOnlyTheMessagesOfADamagedPage) {
  const auto file = database("page.db3", 2000);
  std::string bytes = bytes_of(file);
  constexpr std::size_t page = 4096;
  // A page of the table, which is known by its first byte and by a message that it contains.
  std::size_t at = 5 * page;
  const std::string data("\x00\x01\x00\x00", 4);
  while (bytes[at] != '\x0d' || bytes.substr(at, page).find(data) == std::string::npos) at += page;
  bytes.replace(at, 100, 100, '\x55');
  const auto part = read_bag(write("page.db3", bytes));
  EXPECT_FALSE(part.damage.empty());
  EXPECT_THAT(part.damage[0].reason, HasSubstr("is left out"));
  EXPECT_GT(part.messages.size(), 1000U);
  EXPECT_EQ(part.messages.size() + part.damage.size(), 2000U);
}

TEST_F(Rosbag2, IsReadUpToATimeThatIsNoNumber) {
  const auto file =
      database("text.db3", 2, "INSERT INTO messages VALUES(3, 1, 'noon', x'00010000');");
  EXPECT_EQ(read_bag(file).messages.size(), 2U);
  const BagSummary summary = summarize(file);
  ASSERT_EQ(summary.damage.size(), 1U);
  EXPECT_THAT(summary.damage[0].reason, HasSubstr("not in order"));
  EXPECT_EQ(summary.topics.at(0).messages, 2U);
}

TEST_F(Rosbag2, SaysThatAJournalWasNotRead) {
  const auto file = database("crashed.db3", 2);
  write("crashed.db3-wal", "messages");
  const auto contents = read_bag(file);
  EXPECT_EQ(contents.messages.size(), 2U);
  ASSERT_EQ(contents.damage.size(), 1U);
  EXPECT_THAT(contents.damage[0].reason, HasSubstr("crashed.db3-wal are not read"));
}

// A view could compute for ever.
TEST_F(Rosbag2, RunsNoCodeOfADatabase) {
  const auto file = database(
      "view.db3", 0,
      "DROP TABLE messages; CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL "
      "SELECT id + 1 FROM n) SELECT id, 1 AS topic_id, id AS timestamp, x'00' AS data FROM n;");
  EXPECT_THAT(testing::error_of([&] { open_messages(file, {}); }),
              HasSubstr("cannot be read as a database of rosbag2"));
  EXPECT_THAT(
      testing::error_of([&] { open_messages(database("other.db3", 0, "DROP TABLE topics;"), {}); }),
      HasSubstr("no such table: topics"));
}

}  // namespace
}  // namespace maploop::sensors
