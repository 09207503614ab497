// Real recordings, by makers who do not know maploop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/sensors/bag/bag_contents.h"
#include "tests/support/process.h"

namespace maploop::sensors {
namespace {

using testing::bytes_of;
using testing::kitti_bag;
using testing::read_bag;
using testing::ReadMessage;
using testing::real_bags;
using testing::recorded_bag;

TEST(RealBags, ContainWhatOtherReadersRead) {
  MAPLOOP_REQUIRE_REAL_DATA();
  std::vector<std::string> command{testing::source("tests/sensors/bag/other-readers")};
  for (const auto& file : real_bags()) command.push_back(file);
  const auto others = testing::run(command);
  if (others.status == 77) GTEST_SKIP() << others.error;
  ASSERT_EQ(others.status, 0) << others.error;
  ASSERT_EQ(real_bags().size(), 14U);
  const auto read_by_others = nlohmann::json::parse(others.out);
  for (const auto& [file, expected] : read_by_others.items()) {
    SCOPED_TRACE(file);
    const auto contents = read_bag(file);
    EXPECT_TRUE(contents.damage.empty());
    const auto topics = contents.by_topic();
    ASSERT_EQ(topics.size(), expected["topics"].size());
    for (const auto& [name, theirs] : expected["topics"].items()) {
      SCOPED_TRACE(name);
      const std::vector<ReadMessage>& ours = topics.at(name);
      std::string type = theirs["type"];
      if (const auto at = type.find("/msg/"); at != std::string::npos) type.erase(at, 4);
      EXPECT_EQ(contents.topics.at(name).type, type);
      EXPECT_EQ(contents.topics.at(name).encoding, theirs["encoding"]);
      EXPECT_EQ(ours.size(), theirs["messages"]);
      EXPECT_EQ(std::to_string(to_nanoseconds(ours.front().received)), theirs["first"]);
      EXPECT_EQ(std::to_string(to_nanoseconds(ours.back().received)), theirs["last"]);
      EXPECT_EQ(testing::sha256(ours), theirs["sha256"]);
    }
  }
}

TEST(RealBags, AreSummarizedAsTheyAreRead) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const auto& file : real_bags()) {
    SCOPED_TRACE(file);
    const BagSummary summary = summarize(file);
    EXPECT_TRUE(summary.damage.empty());
    const auto read = read_bag(file).by_topic();
    ASSERT_EQ(summary.topics.size(), read.size());
    const bool exact = file.extension() == ".db3";
    for (const TopicSummary& topic : summary.topics) {
      const std::vector<ReadMessage>& messages = read.at(topic.topic.name);
      EXPECT_EQ(topic.messages, messages.size());
      EXPECT_LE(topic.first, messages.front().received);
      EXPECT_GE(topic.last, messages.back().received);
      if (exact) {
        EXPECT_EQ(topic.first, messages.front().received);
        EXPECT_EQ(topic.last, messages.back().received);
      }
    }
  }
}

TEST(RealBags, AreTheSameInEveryCompression) {
  MAPLOOP_REQUIRE_REAL_DATA();
  // The plain one has three more topics, which the others were filtered by.
  const auto plain = read_bag(recorded_bag("example.bag")).by_topic();
  for (const char* name : {"example-bz2.bag", "example-lz4.bag"}) {
    const auto packed = read_bag(recorded_bag(name)).by_topic();
    EXPECT_GE(packed.size(), 6U);
    for (const auto& [topic, messages] : packed) EXPECT_EQ(messages, plain.at(topic)) << topic;
  }
}

TEST(RealBags, AreTheSameInEveryContainer) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto ros1 = read_bag(kitti_bag("kitti13_ros1_bz2.bag"));
  const auto mcap = read_bag(kitti_bag("kitti13_zstd.mcap"));
  const auto folder = read_bag(kitti_bag("kitti13_ros2_zstd_message"));
  EXPECT_EQ(mcap.by_topic(), folder.by_topic());  // both in CDR
  EXPECT_EQ(ros1.counts(), mcap.counts());
  EXPECT_EQ(ros1.messages.size(), 28U);
  for (const auto& [name, topic] : ros1.topics) {
    EXPECT_EQ(topic.type, mcap.topics.at(name).type);
    EXPECT_NE(topic.definition, "");
    EXPECT_NE(mcap.topics.at(name).definition, "");
  }
}

// What is selected while reading is the same as what is selected afterwards.
void expect_selects(const std::filesystem::path& file) {
  SCOPED_TRACE(file);
  const auto all = read_bag(file);
  const Time middle = all.messages[all.messages.size() / 2].received;
  const std::string last_topic = all.topics.rbegin()->first;
  for (const auto& selection :
       {MessageSelection{{last_topic}, Time::min()}, MessageSelection{{}, middle},
        MessageSelection{{last_topic, "/none"}, middle},
        MessageSelection{{"/none"}, Time::min()}}) {
    std::vector<ReadMessage> expected;
    for (const ReadMessage& message : all.messages) {
      if ((selection.topics.empty() || selection.topics.contains(message.topic)) &&
          message.received >= selection.begin)
        expected.push_back(message);
    }
    EXPECT_EQ(read_bag(file, selection).messages, expected);
  }
}

TEST(RealBags, DeliverWhatIsSelected) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const auto& file : real_bags()) expect_selects(file);
}

TEST(RealBags, WithoutIndexAreReadFromFrontToBack) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const testing::TemporaryFolder folder;
  for (const auto& file : real_bags()) {
    if (file.extension() == ".db3") continue;
    SCOPED_TRACE(file);
    std::string bytes = bytes_of(file);
    if (file.extension() == ".mcap") {
      bytes.resize(testing::mcap_summary_start(bytes));
      bytes += std::string("\x02\x14", 2) + std::string(7 + 20, '\0') + "\x89MCAP0\r\n";
    } else {
      bytes.resize(testing::ros1_index_position(bytes));
      bytes.replace(bytes.find("index_pos=") + 10, 8, 8, '\0');
    }
    const auto cut = testing::write_bytes(folder.path() / file.filename(), bytes);
    const auto contents = read_bag(cut);
    EXPECT_EQ(contents.by_topic(), read_bag(file).by_topic());
    // A bag should have an index; an MCAP file need not.
    EXPECT_EQ(contents.damage.size(), file.extension() == ".mcap" ? 0U : 1U);
    const BagSummary summary = summarize(cut);
    EXPECT_EQ(summary.topics.size(), contents.topics.size());
    for (const TopicSummary& topic : summary.topics)
      EXPECT_EQ(topic.messages, contents.counts().at(topic.topic.name));
    expect_selects(cut);
  }
}

}  // namespace
}  // namespace maploop::sensors
