#include "runtime/core/config.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <string>

#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::runtime {
namespace {

using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::array<std::string_view, 2> modes{"vo", "lidar"};

ConfigTable table_of(std::string_view text) {
  return ConfigDocument::parse(text, "a.toml").root();
}

template <class Action>
std::string config_error(Action action) {
  return maploop::testing::error_of<ConfigError>(action);
}

// Returns what is said of a whole text.
std::string error_in(const std::string& text) {
  return config_error([&] { table_of(text); });
}

template <typename T>
std::string read_error(std::string_view text, std::string_view key, T value) {
  const T before = value;
  const std::string error = config_error([&] { table_of(text).read(key, value); });
  EXPECT_EQ(value, before) << "an error leaves the variable as it is";
  return error;
}

TEST(Config, EveryTypeIsRead) {
  const ConfigTable table = table_of(R"(
    rate_hz = 12.5
    whole = 3
    count = -4
    on = true
    name = "left"
    lever = [1, -0.5, 2.0]
  )");
  double rate = 0, whole = 0;
  int count = 0;
  bool on = false;
  std::string name;
  std::array<double, 3> lever{};
  table.read("rate_hz", rate);
  table.read("whole", whole);
  table.read("count", count);
  table.read("on", on);
  table.read("name", name);
  table.read("lever", lever);
  EXPECT_EQ(rate, 12.5);
  EXPECT_EQ(whole, 3.0);
  EXPECT_EQ(count, -4);
  EXPECT_TRUE(on);
  EXPECT_EQ(name, "left");
  EXPECT_EQ(lever, (std::array{1.0, -0.5, 2.0}));
}

TEST(Config, AbsentKeysKeepTheirDefaults) {
  const ConfigTable table = table_of("").table("fusion").table("gates");
  double rate = 1.5;
  Duration deadline = milliseconds(2);
  std::string mode = "vo";
  table.read("rate_hz", rate);
  table.read("deadline_ms", deadline);
  table.read_one_of("mode", mode, modes);
  EXPECT_EQ(rate, 1.5);
  EXPECT_EQ(deadline, milliseconds(2));
  EXPECT_EQ(mode, "vo");
}

TEST(Config, DurationsAreInTheUnitThatEndsTheKey) {
  const ConfigTable table =
      table_of("a_ns = 7\nb_us = 1.5\nc_ms = 50\nd_s = 0.1\ne_s = -2\nf_ms = 0.0000004");
  for (const auto& [key, expected] :
       std::initializer_list<std::pair<const char*, Duration>>{{"a_ns", Duration(7)},
                                                               {"b_us", Duration(1500)},
                                                               {"c_ms", milliseconds(50)},
                                                               {"d_s", milliseconds(100)},
                                                               {"e_s", std::chrono::seconds(-2)},
                                                               {"f_ms", Duration(0)}}) {
    Duration value = milliseconds(-99);
    table.read(key, value);
    EXPECT_EQ(value, expected) << key;
  }
}

TEST(Config, ADurationKeyWithoutUnitIsTheProgramsError) {
  Duration value{};
  EXPECT_THROW(table_of("").read("deadline", value), std::logic_error);
}

TEST(Config, WrongTypeSaysWhereWhatAndWhatIsAllowed) {
  EXPECT_EQ(read_error("\n[f]\n", "f", 1.0), "a.toml:2:1: f: is a table; it must be a number");
  EXPECT_EQ(read_error("x = \"5\"", "x", 1.0), "a.toml:1:5: x: is a string; it must be a number");
  EXPECT_EQ(read_error("x = 5.0", "x", 1),
            "a.toml:1:5: x: is a floating-point number; it must be an integer");
  EXPECT_EQ(read_error("x = 1", "x", true),
            "a.toml:1:5: x: is an integer; it must be true or false");
  EXPECT_EQ(read_error("x = true", "x", std::string("s")),
            "a.toml:1:5: x: is a boolean; it must be a string");
  EXPECT_EQ(read_error("x_ms = 2020-01-01", "x_ms", milliseconds(1) + Duration(0)),
            "a.toml:1:8: x_ms: is a date or time; it must be a number");
  EXPECT_EQ(config_error([] { table_of("x = [1]").table("x"); }),
            "a.toml:1:5: x: is an array; it must be a table");
}

TEST(Config, NotANumberAndInfinityAreRefused) {
  EXPECT_EQ(read_error("x = nan", "x", 1.0), "a.toml:1:5: x: is nan; it must be a finite number");
  EXPECT_EQ(read_error("x = -inf", "x", 1.0), "a.toml:1:5: x: is -inf; it must be a finite number");
  EXPECT_EQ(read_error("x_s = inf", "x_s", Duration(1)),
            "a.toml:1:7: x_s: is inf; it must be a finite number");
}

TEST(Config, OutOfRangeNamesTheFullKeyAndTheRangeWhoseEndsAreAllowed) {
  const ConfigTable fusion =
      table_of("[nav.fusion]\n\ncount = 0\nwait_ms = 70.5").table("nav").table("fusion");
  int count = 1;
  Duration wait{};
  EXPECT_EQ(config_error([&] { fusion.read_in("count", count, 1, 8); }),
            "a.toml:3:9: nav.fusion.count: is 0; allowed is 1 to 8");
  EXPECT_EQ(config_error([&] { fusion.read_in("wait_ms", wait, Duration(0), milliseconds(50)); }),
            "a.toml:4:11: nav.fusion.wait_ms: is 70.5; allowed is 0 to 50");
  const ConfigTable ends = table_of("b = 8\nc_ms = 50");
  ends.read_in("b", count, 1, 8);
  ends.read_in("c_ms", wait, Duration(0), milliseconds(50));
  EXPECT_EQ(count, 8);
  EXPECT_EQ(wait, milliseconds(50));
}

TEST(Config, NumbersBeyondTheirTypeAreOutOfRange) {
  EXPECT_EQ(read_error("x = 3000000000", "x", 1),
            "a.toml:1:5: x: is 3000000000; allowed is -2147483648 to 2147483647");
  EXPECT_THAT(read_error("x_s = 1e300", "x_s", Duration(1)),
              HasSubstr("is 1e+300; allowed is -9223372036.8"));
  EXPECT_THAT(read_error("x_s = 9223372037", "x_s", Duration(1)), HasSubstr("allowed is"));
  EXPECT_THAT(read_error("x = 99999999999999999999", "x", 1), HasSubstr("a.toml:1:"));
}

TEST(Config, OneOfNamesTheChoices) {
  std::string mode = "vo";
  const ConfigTable table = table_of("mode = \"lidr\"\nother = \"qqqqqq\"\ngood = \"lidar\"");
  EXPECT_EQ(config_error([&] { table.read_one_of("mode", mode, modes); }),
            "a.toml:1:8: mode: is \"lidr\"; did you mean \"lidar\"? allowed is \"vo\", \"lidar\"");
  EXPECT_EQ(config_error([&] { table.read_one_of("other", mode, modes); }),
            "a.toml:2:9: other: is \"qqqqqq\"; allowed is \"vo\", \"lidar\"");
  EXPECT_EQ(mode, "vo");
  table.read_one_of("good", mode, modes);
  EXPECT_EQ(mode, "lidar");
}

TEST(Config, ArraysOfTheWrongLengthOrContentLeaveTheValues) {
  std::array<double, 3> lever = {7, 8, 9};
  EXPECT_EQ(config_error([&] { table_of("lever = [1, 2]").read("lever", lever); }),
            "a.toml:1:9: lever: has 2 elements; it must be an array of 3 numbers");
  EXPECT_EQ(config_error([&] { table_of("lever = [1, 2,\n \"3\"]").read("lever", lever); }),
            "a.toml:2:2: lever: is a string; it must be a number");
  EXPECT_EQ(config_error([&] { table_of("lever = 1").read("lever", lever); }),
            "a.toml:1:9: lever: is an integer; it must be an array of 3 numbers");
  EXPECT_EQ(lever, (std::array{7.0, 8.0, 9.0}));
}

TEST(Config, ArraysOfIntegersHaveAnyLength) {
  std::vector<int> values{7};
  const auto read = [&values](const char* text) {
    ConfigDocument::parse(text, "a.toml").root().read_in("cpus", values, 0, 9);
  };
  read("other = 1");
  EXPECT_EQ(values, std::vector<int>{7});
  read("cpus = [0, 9, 3]");
  EXPECT_EQ(values, (std::vector<int>{0, 9, 3}));
  for (const char* wrong : {"cpus = [1, 10]", "cpus = [-1]", "cpus = [1, 2.5]", "cpus = 1"}) {
    EXPECT_THROW(read(wrong), ConfigError) << wrong;
    EXPECT_EQ(values, (std::vector<int>{0, 9, 3})) << wrong;
  }
  read("cpus = []");
  EXPECT_TRUE(values.empty());
}

TEST(Config, ARuleOfTheCallersOwnFailsAtTheKeysPlace) {
  const ConfigTable table = table_of("\n  low = 5").table("absent");
  EXPECT_EQ(config_error([] { table_of("\n  low = 5").fail("low", "must be below high"); }),
            "a.toml:2:9: low: must be below high");
  EXPECT_EQ(config_error([&] { table.fail("low", "is needed"); }), "a.toml: absent.low: is needed");
}

TEST(Config, BrokenSyntaxSaysWhere) {
  EXPECT_THAT(error_in("a = 1\nb = = 2\n"), StartsWith("a.toml:2:"));
  EXPECT_THAT(error_in("[[cam.left]]\nb = = 2\n"), HasSubstr("in [cam.left]: "));
  for (const char* text : {"[", "a", "a = ", "[a\n", "a = [1, ", "a = \"x", "\xff\xfe",
                           "a = 1 b = 2", "a = 01", "a = 1979-13-45", "\"\" ", "a = {b = 1"}) {
    EXPECT_THAT(error_in(text), StartsWith("a.toml:")) << text;
  }
  EXPECT_NE(error_in("a = " + std::string(100000, '[')), "") << "nested without end";
}

TEST(Config, DuplicateKeysAndTablesAreRefused) {
  EXPECT_THAT(error_in("[fusion]\nrate = 1\nrate = 2\n"),
              AllOf(StartsWith("a.toml:3:"), HasSubstr("fusion.rate")));
  EXPECT_THAT(error_in("[fusion]\nrate = 1\nlever = [\n[1],\n]\ngate.width = 2\nrate = 2\n"),
              HasSubstr("a.toml:7:8: fusion.rate: "))
      << "an array's line that begins with [ is no table";
  EXPECT_THAT(error_in("[fusion.gate]\n[other]\n[fusion.gate]\n"),
              AllOf(StartsWith("a.toml:3:"), HasSubstr("fusion.gate")));
}

TEST(Config, EmptyTextIsAnEmptyDocument) {
  const ConfigDocument document = ConfigDocument::parse("", "a.toml");
  EXPECT_FALSE(document.root().has("x"));
  document.reject_unknown();
}

TEST(ConfigFile, IsLoadedAndNamedInErrors) {
  const maploop::testing::TemporaryFolder folder;
  const std::string path = (folder.path() / "vehicle.toml").string();
  std::ofstream(path) << "x = 1\r\ny = 'a'\r\n";
  const ConfigTable table = ConfigDocument::load(path).root();
  int x = 0;
  table.read("x", x);
  EXPECT_EQ(x, 1);
  EXPECT_EQ(config_error([&] { table.read("y", x); }),
            path + ":2:5: y: is a string; it must be an integer");
}

TEST(Config, KeysThatNestWithoutEndAreRefused) {
  std::string key = "a";
  for (int i = 0; i < 50'000; ++i) key += i % 3 == 0 ? ".a" : i % 3 == 1 ? " . \"]\"" : ".'='";
  EXPECT_EQ(error_in("x = 1\n[" + key + "]\n"),
            "a.toml:2: a key of more than 32 parts between dots");
  EXPECT_NE(error_in(key + " = 1"), "");
  EXPECT_NE(error_in("x = { " + key + " = 1 }"), "");
  EXPECT_NE(error_in("x = \"\"\"\"\\\"\"\"\"\"\n[" + key + "]"), "") << "behind a string of lines";
  EXPECT_NE(error_in("x = '''\n''''\n[" + key + "]"), "");
  EXPECT_NE(error_in("x = 1 # \"\n[" + key + "]"), "") << "a quote in a comment";
}

TEST(Config, DotsInStringsCommentsAndNumbersNestNothing) {
  const std::string dots(100, '.');
  std::string numbers = "1.5";
  for (int i = 0; i < 100; ++i) numbers += ", 1.5";
  EXPECT_EQ(error_in("# " + dots + "\na = \"" + dots + "\\\"" + dots + "\"\nb = '" + dots +
                     "'\nc = \"\"\"\n" + dots + "\"\"\"\nd = [" + numbers + "]\n[e.e.e.e]\n"),
            "");
}

TEST(ConfigFile, WhatIsNoReadableFileIsSaid) {
  const maploop::testing::TemporaryFolder folder;
  const auto error = [](const std::filesystem::path& file) {
    return config_error([&] { ConfigDocument::load(file); });
  };
  EXPECT_THAT(error("/nowhere/vehicle.toml"),
              StartsWith("/nowhere/vehicle.toml: the file is missing"));
  EXPECT_THAT(error(folder.path()), HasSubstr("is a folder"));
  EXPECT_THAT(error("/dev/zero"), HasSubstr("not a regular file")) << "it has no end";
}

}  // namespace
}  // namespace maploop::runtime
