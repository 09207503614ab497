#include "runtime/core/trace_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace maploop::runtime {
namespace {

std::string written(std::string_view value) {
  std::string text;
  append_json(text, value);
  return text;
}

std::string read_back(std::string_view value) {
  return nlohmann::json::parse(written(value)).get<std::string>();
}

TEST(TraceText, EveryOneAndTwoByteTextIsValidJson) {
  for (int first = 0; first < 256; ++first) {
    for (int second = 0; second < 256; ++second) {
      const std::string text{static_cast<char>(first), static_cast<char>(second)};
      const std::string back = read_back(text);
      if (first < 0x80 && second < 0x80) {
        EXPECT_EQ(back, text);
      }
    }
  }
}

TEST(TraceText, WellFormedUtf8IsKept) {
  for (const std::string text : {"\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf",
                                 "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_EQ(read_back(text), text);
  }
}

TEST(TraceText, OverlongSurrogateAndCutUtf8IsReplacedByteByByte) {
  const std::string mark = "\xef\xbf\xbd";
  EXPECT_EQ(read_back("\xc0\x80"), mark + mark);
  EXPECT_EQ(read_back("\xe0\x9f\xbf"), mark + mark + mark);
  EXPECT_EQ(read_back("\xed\xa0\x80"), mark + mark + mark);
  EXPECT_EQ(read_back("\xf4\x90\x80\x80"), mark + mark + mark + mark);
  EXPECT_EQ(read_back("\xf5z"), mark + "z");
  EXPECT_EQ(read_back("\xe2\x82"), mark + mark);
  EXPECT_EQ(read_back("\xf0\x9f\x9a"), mark + mark + mark);
}

TEST(TraceText, MicrosecondsHaveThreeDecimals) {
  std::string text;
  for (const std::int64_t ns : {0, 7, 70, 700, 7000, 1'000'001}) {
    append_microseconds(text, Duration(ns));
    text += ' ';
  }
  append_microseconds(text, Duration::max());
  EXPECT_EQ(text, "0.000 0.007 0.070 0.700 7.000 1000.001 9223372036854775.807");
}

}  // namespace
}  // namespace maploop::runtime
