// Recordings that were cut or damaged, made of real ones; and what is no recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

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

class DamagedBag : public ::testing::Test {
 protected:
  void SetUp() override { MAPLOOP_REQUIRE_REAL_DATA(); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    return write_bytes(folder_.path() / name, bytes);
  }
  std::string error(const std::filesystem::path& path) const {
    return testing::error_of([&] { open_messages(path, {}); });
  }

  testing::TemporaryFolder folder_;
};

// Each topic's messages are the first ones of the whole recording.
void expect_beginning(const testing::BagContents& part, const testing::BagContents& whole) {
  const auto all = whole.by_topic();
  for (const auto& [name, messages] : part.by_topic()) {
    const auto& expected = all.at(name);
    ASSERT_LE(messages.size(), expected.size());
    EXPECT_TRUE(std::equal(messages.begin(), messages.end(), expected.begin())) << name;
  }
}

TEST_F(DamagedBag, IsReadUpToWhereItIsCut) {
  for (const auto& [file, least_half] :
       {std::pair(recorded_bag("example.bag"), 1000UL),   // one chunk, not compressed
        std::pair(recorded_bag("example-lz4.bag"), 0UL),  // one chunk in one block
        std::pair(recorded_bag("example-bz2.bag"), 0UL),  // one chunk in one block
        std::pair(recorded_bag("imu_phidgets_upside_down.bag"), 10'000UL),
        std::pair(kitti_bag("kitti13_zstd.mcap"), 9UL),
        std::pair(recorded_bag("pj_rosbag2_test_0.db3"), 1000UL)}) {
    SCOPED_TRACE(file);
    const std::string bytes = bytes_of(file);
    const auto whole = read_bag(file);
    std::size_t last = 0;
    constexpr std::size_t places = 20;
    for (std::size_t i = 1; i <= places; ++i) {
      const std::size_t size = bytes.size() * i / (places + 1);
      SCOPED_TRACE(size);
      const auto cut = write("cut" + file.extension().string(), bytes.substr(0, size));
      const auto part = read_bag(cut);
      ASSERT_FALSE(part.damage.empty());
      for (const BagDamage& damage : part.damage) {
        EXPECT_EQ(damage.file, cut);
        EXPECT_LE(damage.offset, size);
        EXPECT_NE(damage.reason, "");
      }
      expect_beginning(part, whole);
      EXPECT_GE(part.messages.size(), last);
      last = part.messages.size();
      if (2 * i >= places + 1) {
        EXPECT_GE(last, least_half);
      }
      EXPECT_FALSE(summarize(cut).damage.empty());
    }
  }
}

TEST_F(DamagedBag, LosesOnlyTheChunkWithAFlippedByte) {
  const auto file = kitti_bag("kitti13_zstd.mcap");
  const auto whole = read_bag(file);
  std::string bytes = bytes_of(file);
  bytes[bytes.size() / 2] ^= 0x10;
  const auto part = read_bag(write("flipped.mcap", bytes));
  ASSERT_EQ(part.damage.size(), 1U);
  EXPECT_THAT(part.damage[0].reason, HasSubstr("a chunk is left out"));
  EXPECT_LT(part.damage[0].offset, bytes.size() / 2);
  EXPECT_GT(part.damage[0].offset, 0U);
  EXPECT_LT(part.messages.size(), whole.messages.size());
  EXPECT_GT(part.messages.size(), whole.messages.size() / 4);
  for (const auto& message : part.messages) {
    EXPECT_NE(std::find(whole.messages.begin(), whole.messages.end(), message),
              whole.messages.end());
  }
}

TEST_F(DamagedBag, WithADamagedIndexIsReadFromFrontToBack) {
  const auto file = kitti_bag("kitti13_zstd.mcap");
  std::string bytes = bytes_of(file);
  bytes[testing::mcap_summary_start(bytes) + 20] ^= 1;
  const auto mcap = read_bag(write("index.mcap", bytes));
  ASSERT_EQ(mcap.damage.size(), 1U);
  EXPECT_THAT(mcap.damage[0].reason, HasSubstr("checksum"));
  EXPECT_EQ(mcap.by_topic(), read_bag(file).by_topic());

  bytes = bytes_of(recorded_bag("pj_tilt_laser.bag"));
  bytes[testing::ros1_index_position(bytes) + 2] = '\x7f';  // length of the first record
  const auto bag = read_bag(write("index.bag", bytes));
  EXPECT_GE(bag.damage.size(), 1U);
  EXPECT_THAT(bag.damage[0].reason, HasSubstr("the index cannot be used"));
  EXPECT_EQ(bag.by_topic(), read_bag(recorded_bag("pj_tilt_laser.bag")).by_topic());
}

// A topic that is not in a damaged chunk does not know of the damage: the chunk is not inflated.
TEST_F(DamagedBag, IsNotNoticedInAChunkWithoutSelectedTopics) {
  const auto file = recorded_bag("pj_tilt_laser.bag");
  std::string bytes = bytes_of(file);
  const std::string mark = "compression=";  // of the first chunk
  bytes.replace(bytes.find(mark) + mark.size(), 3, "zzz");
  const auto damaged = write("first_chunk.bag", bytes);
  ASSERT_EQ(read_bag(damaged).damage.size(), 1U);
  const auto all = read_bag(file);
  const Time late = all.messages.back().received;
  const auto selected = read_bag(damaged, {{}, late});
  EXPECT_TRUE(selected.damage.empty());
  EXPECT_FALSE(selected.messages.empty());
}

TEST_F(DamagedBag, ThatIsNoneIsRefused) {
  EXPECT_THAT(error(write("empty.bag", "")), HasSubstr("empty.bag: is empty"));
  EXPECT_THAT(error(write("text.mcap", "This is a text.\n")), HasSubstr("neither a ROS bag"));
  EXPECT_THAT(error(folder_.path() / "none.bag"), HasSubstr("missing"));
  EXPECT_THAT(error(write("old.bag", "#ROSBAG V1.2\n")), HasSubstr("'rosbag fix'"));
  EXPECT_THAT(error(write("other.db3", "SQLite format 3" + std::string(1000, '\0'))),
              HasSubstr("other.db3: cannot be read as a database of rosbag2"));
  EXPECT_FALSE(is_bag(folder_.path() / "empty.bag"));
  EXPECT_FALSE(is_bag(folder_.path() / "text.mcap"));
  EXPECT_FALSE(is_bag(folder_.path() / "none.bag"));
  const testing::TemporaryFolder other;
  write_bytes(other.path() / "notes.txt", "no recording");
  EXPECT_FALSE(is_bag(other.path()));
  EXPECT_THAT(error(other.path()), HasSubstr("has neither metadata.yaml"));
  EXPECT_THROW(summarize(other.path()), std::runtime_error);
  EXPECT_TRUE(is_bag(kitti_bag("kitti13_ros2_zstd_message")));
}

}  // namespace
}  // namespace maploop::sensors
