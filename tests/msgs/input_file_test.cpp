#include "msgs/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include <fstream>
#include <functional>

#include "msgs/input_limits.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

namespace fs = std::filesystem;

std::string refused_because(const std::function<void()>& read) {
  try {
    read();
  } catch (const FileError& error) {
    return error.reason();
  }
  return {};
}

class InputFile : public ::testing::Test {
 protected:
  fs::path plain(const std::string& text) const {
    const fs::path file = folder_.path() / "plain";
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  // Writes one gzip member for each text.
  fs::path compressed(const std::vector<std::string>& texts) const {
    const fs::path file = folder_.path() / "compressed";
    fs::remove(file);
    for (const std::string& text : texts) {
      const gzFile out = gzopen(file.c_str(), "ab");
      gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
      gzclose(out);
    }
    return file;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(InputFile, IsReadWholeWhetherCompressedOrNot) {
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += std::to_string(i) + '\n';
  EXPECT_EQ(read_text(plain(text), text.size()), text);
  EXPECT_EQ(read_text(compressed({text, "and more"}), text.size() + 8), text + "and more");
  EXPECT_EQ(read_text(plain(""), 0), "");
  EXPECT_EQ(read_head(compressed({text}), 4), "0\n1\n");
  EXPECT_EQ(read_head(plain("abc"), 4), "abc");
  std::vector<char> bytes;
  read_bytes(plain(text), text.size(), bytes);
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), text);
}

TEST_F(InputFile, ThatIsTooLargeIsRefusedWithItsName) {
  std::vector<char> bytes;
  EXPECT_NE(
      refused_because([&] { read_bytes(plain("12345"), 4, bytes); }).find("5 bytes, at most 4"),
      std::string::npos);
  EXPECT_NE(refused_because([&] { read_text(plain("12345"), 4); }).find("5 bytes, at most 4"),
            std::string::npos);
  try {
    read_text(plain("12345"), 4);
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), plain("12345").string() + ": " + error.reason());
  }
}

// The file contains 100 MB of zeros in 100 kB.
TEST_F(InputFile, ThatInflatesBeyondItsLimitTakesLittleMoreThanThat) {
  const fs::path file = compressed({std::string(100 << 20, '\0')});
  ASSERT_LT(fs::file_size(file), 200'000u);
  EXPECT_NE(
      refused_because([&] { read_text(file, 1 << 20); }).find("when decompressed, at most 1048576"),
      std::string::npos);
}

TEST_F(InputFile, ThatIsCutOrNoneIsRefused) {
  std::vector<char> bytes;
  EXPECT_EQ(refused_because([&] { read_text(folder_.path() / "none", 9); }), "the file is missing");
  EXPECT_EQ(refused_because([&] { read_bytes(folder_.path(), 9, bytes); }),
            "is a folder, not a regular file");
  const fs::path pipe = folder_.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refused_because([&] { read_text(pipe, 9); }), "not a regular file");
  EXPECT_EQ(refused_because([&] { read_head(pipe, 9); }), "not a regular file");
  const fs::path file = compressed({std::string(1000, 'x')});
  fs::resize_file(file, fs::file_size(file) - 5);
  EXPECT_NE(refused_because([&] { read_text(file, 2000); }).find("damaged or cut"),
            std::string::npos);
}

TEST(InputLimits, TimesAreFarApartWhateverTheyAre) {
  using input_limits::within;
  const Time t = from_nanoseconds(1'317'042'651'000'000'000);
  EXPECT_TRUE(within(Duration(5), t, t + Duration(5)));
  EXPECT_TRUE(within(Duration(5), t + Duration(5), t));
  EXPECT_FALSE(within(Duration(5), t, t + Duration(6)));
  EXPECT_FALSE(within(input_limits::longest_pause, Time::min(), Time::max()));
}

}  // namespace
}  // namespace maploop
