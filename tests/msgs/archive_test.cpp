#include "msgs/archive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>

#include "msgs/image.h"
#include "msgs/input_file.h"
#include "msgs/nav_state.h"
#include "msgs/odometry.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

template <class T>
T through_archive(const T& value) {
  ArchiveWriter writer;
  writer(value);
  const Bytes sealed = seal(writer.content());
  ArchiveReader reader(unseal(sealed));
  T loaded{};
  reader(loaded);
  reader.finish();
  return loaded;
}

std::string refusal(const std::function<void()>& load) {
  try {
    load();
  } catch (const ArchiveError& error) {
    return error.what();
  }
  return {};
}

TEST(Archive, KeepsValuesOfEveryKind) {
  EXPECT_EQ(through_archive(std::string("left\0right", 10)), std::string("left\0right", 10));
  EXPECT_EQ(through_archive(std::vector<double>{}), std::vector<double>{});
  EXPECT_EQ(through_archive(std::vector<std::vector<int>>{{1, 2}, {}, {3}}),
            (std::vector<std::vector<int>>{{1, 2}, {}, {3}}));
  EXPECT_EQ(through_archive(std::optional<int>{}), std::nullopt);
  EXPECT_EQ(through_archive(std::optional<int>{7}), 7);
  EXPECT_EQ((through_archive(std::variant<int, std::string, bool>{"two"})),
            (std::variant<int, std::string, bool>{"two"}));
  EXPECT_EQ(through_archive(std::array<std::uint64_t, 3>{1, 2, 3}),
            (std::array<std::uint64_t, 3>{1, 2, 3}));
  EXPECT_EQ(through_archive(from_nanoseconds(1'317'042'651'174'740'992)),
            from_nanoseconds(1'317'042'651'174'740'992));
  EXPECT_EQ(through_archive(OdometryStatus::implausible), OdometryStatus::implausible);
  EXPECT_EQ(through_archive(true), true);
}

TEST(Archive, KeepsTheBitsOfNumbersThatDifferByNoComparison) {
  EXPECT_TRUE(std::signbit(through_archive(-0.0)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(through_archive(nan)));
}

// conversions_test.cpp compares every other member of every message.
TEST(Archive, KeepsASampleButNotWhenThisMachineReceivedIt) {
  RelativeMotion motion;
  motion.received = MonotonicTime(Duration(7));
  motion.sequence = 8;
  const RelativeMotion loaded = through_archive(motion);
  EXPECT_EQ(loaded.received, MonotonicTime{});
  EXPECT_EQ(loaded.sequence, motion.sequence);
}

TEST(Archive, RefusesWhatIsNoArchive) {
  const Bytes text{'h', 'e', 'l', 'l', 'o', ' ', 'w', 'o', 'r', 'l', 'd'};
  EXPECT_EQ(refusal([&] { unseal(text); }), "it is no archive of maploop");
  EXPECT_EQ(refusal([&] { unseal({}); }), "it is no archive of maploop");
}

TEST(Archive, RefusesACutOneADamagedOneAndOneOfAnotherFormat) {
  ArchiveWriter writer;
  writer(std::vector<int>(100, 1));
  const Bytes sealed = seal(writer.content());
  Bytes bad(sealed.begin(), sealed.end() - 1);
  EXPECT_NE(refusal([&] { unseal(bad); }).find("cut"), std::string::npos);
  bad = sealed;
  bad.back() ^= 1;
  EXPECT_NE(refusal([&] { unseal(bad); }).find("damaged"), std::string::npos);
  bad = sealed;
  bad[8] = 99;
  EXPECT_NE(refusal([&] { unseal(bad); }).find("format is version 99"), std::string::npos);
}

TEST(Archive, BelievesNoLengthThatItCannotHold) {
  ArchiveWriter writer;
  writer(std::uint64_t{1} << 60);
  std::vector<double> values;
  ArchiveReader reader(writer.content());
  EXPECT_NE(refusal([&] { reader(values); }).find("cannot hold"), std::string::npos);
}

struct Large {
  std::string name;
  std::array<double, 1000> values{};
};
template <class Archive>
void archive(Archive& ar, Large& large) {
  ar(large.name);
}

// The length claims as many elements as there are bytes left.
TEST(Archive, TakesNoMemoryForElementsThatAreNotThere) {
  ArchiveWriter writer;
  constexpr std::size_t left = 100'000;
  writer(std::uint64_t{left});
  writer.bytes(Bytes(left, 0xff).data(), left);
  std::vector<Large> values;
  ArchiveReader reader(writer.content());
  EXPECT_NE(refusal([&] { reader(values); }).find("cannot hold"), std::string::npos);
  EXPECT_LE(values.capacity() * sizeof(Large), 2 * left);
  std::vector<double> numbers;
  ArchiveReader again(writer.content());
  EXPECT_NE(refusal([&] { again(numbers); }).find("cannot hold"), std::string::npos);
  EXPECT_EQ(numbers.capacity(), 0u);
}

TEST(Archive, JudgesTheHeaderOfAFileBeforeTheRestIsRead) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "sealed";
  const auto write = [&](const Bytes& bytes) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  };
  const Bytes sealed = seal(Bytes(1000, 7));
  write(sealed);
  EXPECT_EQ(read_sealed(file, 2000), sealed);
  EXPECT_THROW(read_sealed(file, 999), FileError);
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40U);  // sparse
  EXPECT_NE(refusal([&] { read_sealed(file, std::size_t{1} << 50U); }).find("1000 were saved"),
            std::string::npos);
}

TEST(Archive, RefusesAValueOfUnknownKind) {
  ArchiveWriter writer;
  writer(std::uint32_t{2});
  std::variant<int, double> value;
  ArchiveReader reader(writer.content());
  EXPECT_NE(refusal([&] { reader(value); }).find("unknown kind"), std::string::npos);
}

TEST(Archive, NamesTheSectionThatIsWrong) {
  ArchiveWriter writer;
  writer.section("filter", 2);
  ArchiveReader other_name(writer.content());
  EXPECT_NE(refusal([&] {
              other_name.section("odometry", 2);
            }).find("'odometry' expected, but 'filter' is there"),
            std::string::npos);
  ArchiveReader other_version(writer.content());
  EXPECT_NE(refusal([&] {
              other_version.section("filter", 3);
            }).find("version is 2, this program reads version 3"),
            std::string::npos);
}

TEST(Archive, WritingIntoABufferKeepsItsMemory) {
  Bytes buffer;
  buffer.reserve(1000);
  const std::uint8_t* memory = buffer.data();
  ArchiveWriter writer(std::move(buffer));
  writer(std::vector<int>(100, 1));
  EXPECT_EQ(writer.content().data(), memory);
}

}  // namespace
}  // namespace maploop
