// These tests compare the schema and the decoder with lcm-gen's own code for the same types.
#include "msgs/lcm/schema.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <maploop_test_lcm/every_kind_t.hpp>
#include <random>
#include <sstream>
#include <stdexcept>

#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "tests/support/real_data.h"

namespace maploop::schema {
namespace {

using maploop_test_lcm::every_kind_t;

Schema schema_of(const std::string& text) {
  const TypeText one[] = {{"a.lcm", text}};
  return Schema(one);
}

std::string refusal(const std::string& text) {
  try {
    schema_of(text);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

std::string every_kind_text() {
  std::ostringstream text;
  text << std::ifstream(maploop::testing::source("tests/msgs/every_kind.lcm")).rdbuf();
  return text.str();
}

const Type& every_kind() {
  static const Schema schema = schema_of(every_kind_text());
  return *schema.find("maploop_test_lcm.every_kind_t");
}

// Adds the values of a field and of those inside it, by path.
void add(const Field& field, const std::string& path, std::map<std::string, std::string>& all) {
  for (std::size_t i = 0; i < field.count(); ++i) {
    EXPECT_TRUE(all.emplace(path + index_text(field, i), field.text(i)).second);
  }
  for (std::size_t i = 0; i < field.inner.size(); ++i) {
    add(field.inner[i], inner_path(field, i, path), all);
  }
}

std::map<std::string, std::string> fields(const Type& type, std::span<const std::uint8_t> message) {
  std::map<std::string, std::string> all;
  add(decode(type, message), "", all);
  return all;
}

// Returns why the bytes are not a message of the type; nothing if they are.
std::string refusal(const Type& type, std::span<const std::uint8_t> bytes) {
  try {
    decode(type, bytes);
  } catch (const DecodeError& e) {
    EXPECT_LE(e.offset(), bytes.size());
    EXPECT_STRNE(e.what(), "");
    return e.what();
  }
  return "";
}

every_kind_t sample(int children) {
  every_kind_t m;
  m.yes = 1;
  m.octet = 200;
  m.small = static_cast<std::int8_t>(children);
  m.medium = 2;
  m.other = -3;
  m.rows = 2;
  m.big = std::numeric_limits<std::int64_t>::min();
  m.single = 0.1F;
  m.number = 0.1;
  m.text = "say \"hi\"\n";
  m.leaf.n = 1;
  m.leaf.values = {-0.0F};
  m.grid = {{1, 2, 3}, {4, 5, -6}};
  using Names = std::vector<std::string>;
  m.names = {Names{"a", "b"}, Names{"c", "d"}};
  m.leaves.resize(2, std::vector<maploop_test_lcm::leaf_t>(2, m.leaf));
  m.leaves[1][0].n = 0;
  m.leaves[1][0].values.clear();
  for (int i = 0; i < 16; ++i) m.blob[i] = static_cast<std::uint8_t>(240 + i);
  if (children > 0) m.children.assign(static_cast<std::size_t>(children), sample(0));
  return m;
}

template <class... Lcm>
void expect_generated_fingerprints(const std::string& package) {
  const auto expect = [&](const char* name, std::int64_t hash) {
    const Type* type = own_schema().find(package + name);
    ASSERT_NE(type, nullptr) << name;
    EXPECT_EQ(type->fingerprint, static_cast<std::uint64_t>(hash)) << name;
    EXPECT_EQ(own_schema().find(type->fingerprint), type);
  };
  (expect(Lcm::getTypeName(), Lcm::getHash()), ...);
}

TEST(Schema, FingerprintsAreThoseOfTheGeneratedCode) {
  using namespace maploop_lcm;
  expect_generated_fingerprints<
      header_t, imu_t, gnss_fix_t, wheel_speed_t, nav_state_t, odom_state_t, nav_protection_t,
      separation_t, reference_pose_t, preview_t, relative_motion_t, lidar_motion_t, map_doubt_t,
      map_feedback_t, map_match_t, map_candidate_t, latency_summary_t, histogram_t,
      missed_deadline_t, thread_health_t, ring_health_t, sensor_health_t, deadlines_t, health_t>(
      "maploop_lcm.");
  EXPECT_EQ(every_kind().fingerprint, static_cast<std::uint64_t>(every_kind_t::getHash()))
      << "it contains itself";
}

TEST(Schema, ErrorsNameFileLineAndWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"struct a {\n  int x;\n}", "a.lcm:2: the type 'int' is not known"},
      {"struct a {\n\n b.c_t x; }", "a.lcm:3: the type 'b.c_t' is not known"},
      {"struct a { int8_t x }", "';' is missing before '}'"},
      {"struct a { double n; int8_t x[n]; }", "'n' is not the size of an array"},
      {"struct a { int8_t x[n]; int32_t n; }", "'n' is not the size of an array"},
      {"struct a { int8_t x[0]; }", "'0' is not the size"},
      {"struct a { int8_t x[99999999999]; }", "is not the size"},
      {"struct a { int8_t x;", "the end of the file"},
      {"struct a { const int8_t X = 1", "the end of the file"},
      {"struct a { int8_t 2x; }", "'2x' is not a name"},
      {"enum a { B }", "'struct' or 'package' is missing before 'enum'"},
      {"package ..a;", "'..a' is not a name"},
      {"/* no end", "comment has no end"},
      {"struct a { int8_t \x01; }", "'?' is not a name"}};
  for (const auto& [text, what] : wrong) {
    const std::string said = refusal(text);
    EXPECT_TRUE(said.starts_with("a.lcm:")) << text << ": " << said;
    EXPECT_NE(said.find(what), std::string::npos) << text << ": " << said;
  }
}

TEST(Schema, TypesMayStandInAnyOrderAndFile) {
  const TypeText texts[] = {{"a.lcm", "package p; struct a { b x; q.c y; }"},
                            {"c.lcm", "package q; struct c { int8_t n; }"},
                            {"b.lcm", "package p; struct b { int8_t n; }"}};
  const Schema schema(texts);
  EXPECT_EQ(schema.size(), 3U);
  EXPECT_EQ(schema.find("p.a")->members[1].type, schema.find("q.c"));
  // The types differ only in name; LCM cannot distinguish them either.
  EXPECT_EQ(schema.find("q.c")->fingerprint, schema.find("p.b")->fingerprint);
}

TEST(Schema, TheSameTypeTwiceIsFineAnotherOfItsNameIsNot) {
  EXPECT_EQ(schema_of("struct a { int8_t x; } struct a { int8_t x; }").size(), 1U);
  EXPECT_NE(refusal("struct a { int8_t x; }\nstruct a { int8_t y; }").find("a.lcm:2: the type 'a'"),
            std::string::npos);
}

TEST(Schema, NestingThatDoublesWithEachLevelIsRefused) {
  std::string text = "struct t0 { int8_t x; }";
  for (int i = 1; i < 60; ++i) {
    const std::string below = "t" + std::to_string(i - 1);
    text.append("struct t").append(std::to_string(i)).append(" {");
    text.append(below).append(" a; ").append(below).append(" b; }");
  }
  EXPECT_NE(refusal(text).find("nested too deeply"), std::string::npos);
}

TEST(Schema, DamagedTextNeverCrashes) {
  std::mt19937 random(20110926);
  const std::string whole = every_kind_text();
  int refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = whole;
    for (auto n = random() % 4; n > 0; --n) {
      text[random() % text.size()] = "{}[];,=/*0x._-\n\x80"[random() % 17];
    }
    text.erase(random() % text.size(), random() % 30);
    if (!refusal(text).empty()) ++refused;
  }
  EXPECT_GT(refused, 2000);
}

TEST(DecodedMessage, EveryKindOfFieldIsExact) {
  const auto all = fields(every_kind(), encoded(sample(1)));
  const std::map<std::string, std::string> expected{{"yes", "true"},
                                                    {"octet", "200"},
                                                    {"other", "-3"},
                                                    {"big", "-9223372036854775808"},
                                                    {"single", "0.1"},
                                                    {"number", "0.1"},
                                                    {"text", "\"say \\\"hi\\\"\\x0a\""},
                                                    {"leaf.values[0]", "-0"},
                                                    {"grid[1][2]", "-6"},
                                                    {"grid[0][1]", "2"},
                                                    {"names[1][0]", "\"c\""},
                                                    {"leaves[1][0].n", "0"},
                                                    {"leaves[1][1].values[0]", "-0"},
                                                    {"blob[15]", "255"},
                                                    {"children[0].names[0][1]", "\"b\""}};
  for (const auto& [path, text] : expected) {
    ASSERT_TRUE(all.contains(path)) << path;
    EXPECT_EQ(all.at(path), text) << path;
  }
  EXPECT_FALSE(all.contains("leaves[1][0].values[0]"));
  // The message has 10 scalars besides the text, grid, names, leaf and four leaves, blob; twice.
  EXPECT_EQ(all.size(), 2U * (10 + 6 + 4 + 2 + 7 + 16));
}

TEST(DecodedMessage, OwnTypeWithStringsAndNesting) {
  Health health;
  health.stamp = from_nanoseconds(1'317'042'651'174'740'000);
  health.threads.resize(1);
  health.threads[0].name = "fusion";
  health.threads[0].rate = 100.0;
  health.degraded = {"no real-time priority", ""};
  const auto all = fields(*own_schema().find("maploop_lcm.health_t"), encoded(to_lcm(health)));
  EXPECT_EQ(all.at("utime"), "1317042651174740");
  EXPECT_EQ(all.at("threads[0].name"), "\"fusion\"");
  EXPECT_EQ(all.at("threads[0].rate_hz"), "100");
  EXPECT_EQ(all.at("degraded[0]"), "\"no real-time priority\"");
  EXPECT_EQ(all.at("degraded[1]"), "\"\"");
}

TEST(DecodedMessage, MessageCutAnywhereOrTooLongIsRefused) {
  auto bytes = encoded(sample(1));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_NE(refusal(every_kind(), std::span(bytes).first(size)), "") << size;
  }
  bytes.push_back(0);
  EXPECT_EQ(refusal(every_kind(), bytes), "1 bytes follow the last field");
}

TEST(DecodedMessage, ErrorsNameTheField) {
  auto message = sample(2);
  message.children[1].leaves[1][0].n = -1;
  EXPECT_EQ(refusal(every_kind(), encoded(message)),
            "'children[1].leaves[1][0].values': 'n' gives it the size -1");
}

TEST(DecodedMessage, HostileSizesAreRefusedByName) {
  const Schema schema = schema_of(
      "struct empty {}\n"
      "struct a { int64_t n; int64_t m; double x[n][m]; }\n"
      "struct b { int32_t n; empty x[n]; }\n"
      "struct c { c inner; }");
  // Decodes a message of the fingerprint and of further words.
  const auto reason = [&](const char* name, std::vector<std::uint64_t> words, std::size_t cut = 0) {
    const Type& type = *schema.find(name);
    words.insert(words.begin(), type.fingerprint);
    std::vector<std::uint8_t> bytes;
    for (const std::uint64_t word : words) {
      for (int shift = 56; shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<std::uint8_t>(word >> shift));
      }
    }
    bytes.resize(bytes.size() - cut);
    return refusal(type, bytes);
  };
  constexpr std::uint64_t minus_one = ~std::uint64_t{0};
  EXPECT_EQ(reason("a", {minus_one, 1}), "'x': 'n' gives it the size -1");
  EXPECT_EQ(reason("a", {1, minus_one}), "'x': 'm' gives it the size -1");
  for (const std::uint64_t huge : {1ULL << 31, 1ULL << 32, 1ULL << 33, 1ULL << 62}) {
    EXPECT_NE(reason("a", {huge, huge}), "");
    EXPECT_NE(reason("a", {huge, 1}), "");
    EXPECT_EQ(reason("a", {huge, 0}), "");  // no element at all
    EXPECT_EQ(reason("a", {0, huge}), "");
  }
  EXPECT_EQ(reason("b", {0x7fffffffULL << 32}, 4), "'x': more than 1000000 fields");
  EXPECT_EQ(reason("b", {1000ULL << 32}, 4), "");
  EXPECT_NE(reason("c", {}).find("nested too deeply"), std::string::npos);
}

TEST(DecodedMessage, FlippedBitsNeverCrashAndAcceptedValuesCanBeShown) {
  const auto whole = encoded(sample(2));
  std::mt19937 random(20110926);
  int accepted = 0;
  for (int round = 0; round < 20000; ++round) {
    auto bytes = whole;
    for (auto n = 1 + random() % 3; n > 0; --n) {
      bytes[8 + random() % (bytes.size() - 8)] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    if (!refusal(every_kind(), bytes).empty()) continue;
    ++accepted;
    EXPECT_GT(fields(every_kind(), bytes).size(), 20U);
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_LT(accepted, 20000);
}

TEST(DecodedMessage, TextGivesTheSameBitsBack) {
  auto message = sample(0);
  const auto text_of = [&](const char* field) {
    return fields(every_kind(), encoded(message)).at(field);
  };
  message.number = 1.0 / 3.0;
  EXPECT_EQ(text_of("number"), "0.3333333333333333");
  message.number = std::nan("");
  EXPECT_EQ(text_of("number"), "nan");
  message.number = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(text_of("number"), "-inf");
  message.single = 16777216.0F;
  EXPECT_EQ(text_of("single"), "16777216");
  message.text = "a\x7f\x1b";
  EXPECT_EQ(text_of("text"), "\"a\\x7f\\x1b\"");
}

}  // namespace
}  // namespace maploop::schema
