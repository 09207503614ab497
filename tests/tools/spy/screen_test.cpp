#include "tools/spy/screen.h"

#include <gtest/gtest.h>

#include <regex>
#include <stdexcept>
#include <string>

#include "tests/tools/spy/messages.h"

namespace maploop::spy {
namespace {

using std::chrono::seconds;

class SpyScreen : public ::testing::Test {
 protected:
  SpyScreen() {
    for (const char* channel : {"ALPHA", "BETA", "GAMMA"}) {
      traffic_.add(channel, imu(channel[0], {}), seconds(1));
    }
  }

  void press(const std::string& keys) {
    for (const char key : keys) screen_.press(key);
  }

  std::string picture(std::size_t rows = 40, std::size_t columns = 140) {
    return screen_.picture(traffic_, seconds(1), rows, columns);
  }

  // Returns the row in reverse video.
  std::string selected() {
    const std::string all = picture();
    const std::size_t begin = all.find("\x1b[7m") + 4;
    return all.substr(begin, all.find(' ', begin) - begin);
  }

  Traffic traffic_{own_schema(), seconds(5)};
  Screen screen_{"a bus", ""};
};

const std::string up = "\x1b[A", down = "\x1b[B", page_down = "\x1b[6~";

TEST_F(SpyScreen, ArrowsSelectAndStopAtTheEnds) {
  EXPECT_EQ(selected(), "ALPHA");
  press(down);
  EXPECT_EQ(selected(), "BETA");
  press(down + down + down);
  EXPECT_EQ(selected(), "GAMMA");
  press(up);
  EXPECT_EQ(selected(), "BETA");
  traffic_.add("ADAM", imu(0, {}), seconds(1));
  EXPECT_EQ(selected(), "BETA") << "stays, whatever comes above it";
}

TEST_F(SpyScreen, ShowsTheFieldsOfTheSelectedChannel) {
  EXPECT_NE(picture().find("header.sequence = 65"), std::string::npos);
  press(down);
  EXPECT_NE(picture().find("header.sequence = 66"), std::string::npos);
  EXPECT_NE(picture().find("yaw_rate = 0.25"), std::string::npos);
  press(page_down);
  EXPECT_EQ(picture().find("header.sequence"), std::string::npos) << "scrolled away";
}

TEST_F(SpyScreen, AFilterIsTypedAndCorrected) {
  press("/ETX\x7f");
  EXPECT_NE(picture().find("/ET_"), std::string::npos);
  EXPECT_NE(picture().find("ALPHA"), std::string::npos) << "not before it is entered";
  press("q\x7f\r");
  EXPECT_FALSE(screen_.quit()) << "a letter of the filter";
  EXPECT_EQ(picture().find("ALPHA"), std::string::npos);
  EXPECT_EQ(selected(), "BETA");
  press("/\x7f\x7f\r");
  EXPECT_NE(picture().find("ALPHA"), std::string::npos);
}

TEST_F(SpyScreen, AWrongFilterIsNamedAndTheOldOneStays) {
  press("/A(\r");
  EXPECT_NE(picture().find("not a regular expression"), std::string::npos);
  EXPECT_NE(picture().find("BETA"), std::string::npos);
  EXPECT_THROW(filter_of(")("), std::invalid_argument);
}

TEST_F(SpyScreen, EscapeCancelsTheTypingAndQQuits) {
  press("/zzz\x1b");
  EXPECT_NE(picture().find("ALPHA"), std::string::npos);
  press("q");
  EXPECT_TRUE(screen_.quit());
}

TEST_F(SpyScreen, FitsEveryTerminal) {
  for (const std::size_t rows : {1u, 2u, 3u, 7u, 24u, 200u}) {
    for (const std::size_t columns : {1u, 20u, 80u}) {
      const std::string all = picture(rows, columns);
      std::size_t lines = 1;
      for (const char c : all) lines += c == '\n' ? 1 : 0;
      EXPECT_LE(lines, rows);
      const std::string plain = std::regex_replace(all, std::regex("\x1b\\[[0-9;?]*[A-Za-z]"), "");
      for (std::size_t begin = 0; begin < plain.size();) {
        const std::size_t end = std::min(plain.find("\r\n", begin), plain.size());
        // The help is in the last row, after a cursor movement instead of a line end.
        if (end < plain.size()) {
          EXPECT_LE(end - begin, columns);
        }
        begin = end + 2;
      }
    }
  }
  Screen nothing("a bus", "");
  EXPECT_NE(nothing.picture(Traffic(own_schema(), seconds(5)), {}, 24, 80).find("nothing heard"),
            std::string::npos);
}

}  // namespace
}  // namespace maploop::spy
