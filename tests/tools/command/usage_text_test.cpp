#include "tools/command/usage_text.h"

#include <gtest/gtest.h>

namespace maploop::tools {
namespace {

TEST(WrappedText, ALineThatFitsStaysAsItIs) {
  EXPECT_EQ(wrapped("  a   b\n\nc\n", 10), "  a   b\n\nc\n");
  EXPECT_EQ(wrapped("", 10), "");
}

TEST(WrappedText, ATableGoesOnBelowItsLastColumn) {
  EXPECT_EQ(wrapped("  --json FILE   write it to this file\nnext", 34),
            "  --json FILE   write it to this\n"
            "                file\n"
            "next");
}

TEST(WrappedText, AParagraphGoesOnBelowItsBegin) {
  EXPECT_EQ(wrapped("one two three four", 9), "one two\nthree\nfour");
  EXPECT_EQ(wrapped("  one two three", 11), "  one two\n  three");
}

TEST(WrappedText, AWordThatIsTooLongStaysWhole) {
  EXPECT_EQ(wrapped("abcdefghijkl mn", 5), "abcdefghijkl\nmn");
  EXPECT_EQ(wrapped("    abcdefghijkl", 5), "    abcdefghijkl");
}

}  // namespace
}  // namespace maploop::tools
