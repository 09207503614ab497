// MCAP files made here, in the forms that no real one of the others has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zlib.h>

#include "tests/sensors/bag/bag_contents.h"
#include "tests/sensors/bag/made_mcap.h"

namespace maploop::sensors {
namespace {

using ::testing::HasSubstr;

using namespace made_mcap;

std::string chunk(const std::string& plain, const std::string& compression,
                  const std::string& packed, std::uint32_t crc = 0) {
  return record(6, field(std::uint64_t{0}) + field(std::uint64_t{0}) +
                       field(std::uint64_t{plain.size()}) + field(crc) + text(compression) +
                       field(std::uint64_t{packed.size()}) + packed);
}
std::string lz4(const std::string& plain) {
  std::string packed(LZ4F_compressFrameBound(plain.size(), nullptr), '\0');
  packed.resize(
      LZ4F_compressFrame(packed.data(), packed.size(), plain.data(), plain.size(), nullptr));
  return packed;
}
std::uint32_t crc_of(const std::string& plain) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(plain.data()), static_cast<uInt>(plain.size())));
}

const std::string declarations = schema(1, "sensor_msgs/msg/Imu", "ros2msg") +
                                 channel(1, "/imu", "cdr") + schema(2, "some.Proto", "protobuf") +
                                 channel(2, "/proto", "protobuf") + channel(3, "/raw", "");

class Mcap : public ::testing::Test {
 protected:
  testing::BagContents read(const std::string& records,
                            const MessageSelection& selection = {}) const {
    return testing::read_bag(testing::write_bytes(folder_.path() / "made.mcap", file(records)),
                             selection);
  }
  // The data of the messages, one after the other.
  static std::string data(const testing::BagContents& contents) {
    std::string all;
    for (const auto& m : contents.messages) all += m.data;
    return all;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Mcap, HasMessagesOfAnyEncodingOutsideOfChunks) {
  const std::string attachment = record(9, std::string(1000, 'x'));
  const std::string unknown = record('\x90', "private");
  const auto contents = read(declarations + message(1, 5, "a") + attachment + unknown +
                             message(2, 6, "b") + message(3, 7, "c"));
  EXPECT_TRUE(contents.damage.empty());
  EXPECT_EQ(data(contents), "abc");
  EXPECT_EQ(contents.messages[2].received, from_nanoseconds(7));
  const Topic& imu = contents.topics.at("/imu");
  EXPECT_EQ(imu.type, "sensor_msgs/Imu");
  EXPECT_EQ(imu.encoding, "cdr");
  EXPECT_EQ(imu.definition, "the definition");
  EXPECT_EQ(contents.topics.at("/proto").type, "some.Proto");
  EXPECT_EQ(contents.topics.at("/proto").definition, "");  // it is not a text
  EXPECT_EQ(contents.topics.at("/raw").type, "");
}

TEST_F(Mcap, HasItsChunksMessagesInTheOrderOfTime) {
  const std::string first = declarations + message(1, 9, "d") + message(2, 3, "a") +
                            message(1, 3, "b") + message(1, 5, "c");
  const std::string second = message(1, 10, "e");
  for (const std::uint32_t crc : {0U, crc_of(first)}) {
    const auto contents =
        read(chunk(first, "lz4", lz4(first), crc) + chunk(second, "", second, crc_of(second)));
    EXPECT_TRUE(contents.damage.empty());
    EXPECT_EQ(data(contents), "abcde");
  }
  EXPECT_EQ(data(read(chunk(first, "", first), {{"/imu"}, from_nanoseconds(5)})), "cd");
}

TEST_F(Mcap, LeavesOutWhatIsDamagedAndSaysWhere) {
  const std::string good = declarations + message(1, 1, "good");
  const std::string bad_inside = message(7, 2, "no channel") + record(5, "short") +
                                 message(1, ~std::uint64_t{0}, "no time") + message(1, 3, "ok");
  const struct {
    std::string records, reason, data;
  } cases[] = {
      {chunk(bad_inside, "", bad_inside), "3 records of this chunk are left out: nothing states",
       "ok"},
      {chunk(good, "lz4", lz4(good), 1), "checksum (CRC) is wrong", ""},
      {chunk(good, "lz4", lz4(good).substr(0, 60)), "are cut: they inflate to only", ""},
      {chunk(good + "x", "lz4", lz4(good)), "are cut: they inflate to only", ""},
      {chunk(good, "lz4", lz4(good + "x")), "inflate to more than", ""},
      {chunk(good, "zstd", "no frame of it"), "its compressed data are damaged", ""},
      {chunk(good, "bz2", "no frame of it"), "not the data of bzip2", ""},
      {chunk(good, "snappy", good), "compression is not", ""},
      {chunk(good, "", good + "x"), "are not the stated", ""},
      {message(7, 2, "no channel"), "nothing states the topic of channel 7", ""},
      {message(1, ~std::uint64_t{0}, "late"), "are not a time between 1970 and 2200", ""},
      {record(6, "short"), "a field of 16 bytes is followed by only 5", ""},
      {record(6, std::string(16, '\0') + std::string(8, '\xff') + field(0U) + text("zstd") +
                     field(std::uint64_t{0})),
       "are more than the", ""},
  };
  for (const auto& [records, reason, delivered] : cases) {
    SCOPED_TRACE(reason);
    const auto contents = read(good + records + message(1, 8, "after"));
    ASSERT_EQ(contents.damage.size(), 1U);
    EXPECT_THAT(contents.damage[0].reason, HasSubstr(reason));
    const std::size_t before = file("").size() - 13 - 37;  // magic and header
    EXPECT_EQ(contents.damage[0].offset, before + good.size());
    EXPECT_EQ(data(contents), "good" + delivered + "after");
  }
}

TEST_F(Mcap, EndsWhereThereIsNoRecord) {
  const auto contents = read(declarations + message(1, 1, "good") + std::string(100'000, '\0') +
                             message(1, 2, "lost"));
  ASSERT_EQ(contents.damage.size(), 1U);
  EXPECT_THAT(contents.damage[0].reason, HasSubstr("there is no record here"));
  EXPECT_EQ(data(contents), "good");
}

}  // namespace
}  // namespace maploop::sensors
