#include <gtest/gtest.h>

#include <string>

#include "runtime/core/config.h"
#include "tests/support/error_of.h"

namespace maploop::runtime {
namespace {

using maploop::testing::error_of;

// Reads a document as a program with two components would; returns the error of reject_unknown().
std::string unknown_in(std::string_view text) {
  const ConfigDocument document = ConfigDocument::parse(text, "a.toml");
  double number = 0;
  Duration duration{};
  const ConfigTable fusion = document.root().table("fusion");
  fusion.read("rate_hz", number);
  fusion.read("deadline_ms", duration);
  document.root().table("match").read("radius", number);
  static constexpr MovedKey moved[] = {{"fusion.hertz", "fusion.rate_hz"},
                                       {"old.size", "match.radius"},
                                       {"old.speed", "nowhere"},
                                       {"old.rate", "fusion.rate_hz in Hz"},
                                       {"older", "[fusion]"}};
  return error_of<ConfigError>([&] { document.reject_unknown(moved); });
}

TEST(ConfigUnknownKey, NothingUnknownIsNoError) {
  EXPECT_EQ(unknown_in(""), "");
  EXPECT_EQ(unknown_in("[fusion]\nrate_hz = 1\n[match]\nradius = 2"), "");
}

TEST(ConfigUnknownKey, MisspelledNamesItsNearest) {
  EXPECT_EQ(unknown_in("[fusion]\n  rat_hz = 1"),
            "a.toml:2:3: fusion.rat_hz: unknown key; did you mean fusion.rate_hz? "
            "in [fusion] the keys are: deadline_ms, rate_hz");
}

TEST(ConfigUnknownKey, MisspelledTable) {
  EXPECT_EQ(unknown_in("[fuson]\nrate_hz = 1"),
            "a.toml:1:2: fuson: unknown key; did you mean fusion? "
            "at the top level the keys are: fusion, match");
}

TEST(ConfigUnknownKey, RightNameInTheWrongTable) {
  EXPECT_EQ(unknown_in("[fusion]\nradius = 1"),
            "a.toml:2:1: fusion.radius: unknown key; did you mean match.radius? "
            "in [fusion] the keys are: deadline_ms, rate_hz");
}

TEST(ConfigUnknownKey, FarFromEverythingHasNoGuess) {
  EXPECT_EQ(unknown_in("[fusion]\ncolour = 1"),
            "a.toml:2:1: fusion.colour: unknown key; "
            "in [fusion] the keys are: deadline_ms, rate_hz");
}

TEST(ConfigUnknownKey, OneThatMovedNamesItsPlace) {
  EXPECT_EQ(unknown_in("[fusion]\nhertz = 1"),
            "a.toml:2:1: fusion.hertz: unknown key; its place is now fusion.rate_hz");
  EXPECT_EQ(unknown_in("[old]\nrate = 1\nsize = 2"),
            "a.toml:1:2: old: unknown key; the place of old.size is now match.radius, of old.rate "
            "is now fusion.rate_hz in Hz");
  EXPECT_EQ(unknown_in("[older]\nrate = 1"),
            "a.toml:1:2: older: unknown key; its place is now [fusion]");
}

TEST(ConfigUnknownKey, AllAreNamedInTheFilesOrder) {
  const std::string text = unknown_in("zzz = 1\n[match]\nradus = 1\n[fusion]\nrate = 1");
  const std::size_t first = text.find("a.toml:1:1: zzz:");
  const std::size_t second = text.find("\na.toml:3:1: match.radus:");
  const std::size_t third = text.find("\na.toml:5:1: fusion.rate:");
  EXPECT_EQ(first, 0u) << text;
  EXPECT_LT(second, third) << text;
  EXPECT_NE(third, std::string::npos) << text;
}

TEST(ConfigUnknownKey, ControlCharactersStayOnTheLine) {
  const std::string text = unknown_in("\"a\\nb\" = 1");
  EXPECT_EQ(text.rfind("a.toml:1:1: \"a?b\": unknown key", 0), 0u) << text;
}

TEST(ConfigUnknownKey, ADocumentNobodyAskedIsAllUnknown) {
  EXPECT_THROW(ConfigDocument::parse("x = 1", "a.toml").reject_unknown(), ConfigError);
}

}  // namespace
}  // namespace maploop::runtime
