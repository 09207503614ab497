#include "msgs/whole_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

using maploop::testing::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class WholeFileTest : public ::testing::Test {
 protected:
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
  }
  maploop::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a.txt";
};

TEST_F(WholeFileTest, IsThereWhenItIsKept) {
  const std::string text(200'000, 'x');
  write_whole_file(file_, text);
  EXPECT_EQ(content(file_), text);
  EXPECT_EQ(files(), 1u) << "and nothing else";
}

TEST_F(WholeFileTest, UntilThenWhatWasThereBeforeIsWhole) {
  write_whole_file(file_, "old");
  {
    WholeFile half(file_);
    half.write(std::string(200'000, 'x'));
    EXPECT_EQ(content(file_), "old");
  }
  EXPECT_EQ(content(file_), "old") << "also where it is never kept";
  EXPECT_EQ(files(), 1u);
  write_whole_file(file_, "new");
  EXPECT_EQ(content(file_), "new");
}

TEST_F(WholeFileTest, ALinkStaysALink) {
  const auto link = folder_.path() / "link";
  std::filesystem::create_symlink("a.txt", link);
  write_whole_file(link, "text");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(content(file_), "text");
}

TEST_F(WholeFileTest, AForeignLinkInPlaceOfTheFileInProgressIsNotFollowed) {
  const auto precious = folder_.path() / "precious";
  std::ofstream(precious) << "kept";
  std::filesystem::create_symlink("precious", folder_.path() / "a.txt.part");
  EXPECT_THAT(error_of([&] { write_whole_file(file_, "text"); }), HasSubstr("a.txt"));
  EXPECT_EQ(content(precious), "kept");
}

TEST_F(WholeFileTest, ADeviceIsWrittenAsItIs) {
  write_whole_file("/dev/null", "text");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

// This is the case of /dev/stdout when a shell reads what a command writes.
TEST_F(WholeFileTest, APipeIsWrittenThroughItsName) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  write_whole_file("/proc/self/fd/" + std::to_string(ends[1]), "all");
  std::array<char, 8> read{};
  EXPECT_EQ(::read(ends[0], read.data(), read.size()), 3);
  EXPECT_EQ(std::string(read.data()), "all");
  close(ends[0]);
  close(ends[1]);
}

TEST_F(WholeFileTest, WhatCannotBeWrittenIsNamedWithItsReason) {
  const auto error = [](const std::filesystem::path& file) {
    return error_of([&] { write_whole_file(file, "text"); });
  };
  EXPECT_THAT(error("/no such folder/a"),
              StartsWith("cannot write '/no such folder/a': No such file or directory; "));
  EXPECT_THAT(error("/dev/full"), StartsWith("cannot write '/dev/full': No space left on device"));
  EXPECT_THAT(error(folder_.path()), HasSubstr("Is a directory"));
}

}  // namespace
}  // namespace maploop
