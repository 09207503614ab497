#include "tools/command/usage_text.h"

#include <gtest/gtest.h>

#include "tools/command/progress.h"
#include "tools/command/terminal.h"

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

TEST(ProgressText, SaysTheShareAndTheTimeLeft) {
  EXPECT_EQ(progress_text("frames", 100.0, 400.0, 5.0), "100 of 400 frames, 25 %, 15 s left");
  EXPECT_EQ(progress_text("frames", 400.0, 400.0, 5.0), "400 of 400 frames, 100 %, 0 s left");
}

TEST(ProgressText, SaysTheTimeTakenWhereTheEndIsNotKnown) {
  EXPECT_EQ(progress_text("frames", 100.0, 0.0, 5.0), "100 frames, 5 s");
}

TEST(InColour, TextForAPipeHasNoControlCharacters) {
  EXPECT_EQ(in_colour(-1, "refused   clock\nNote: it is late\n"),
            "refused   clock\nNote: it is late\n");
}

}  // namespace
}  // namespace maploop::tools
