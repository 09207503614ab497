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

#include "msgs/lcm/conversions.h"
#include "msgs/lcm/decoded_message.h"
#include "tests/support/real_data.h"

namespace maploop::schema {
namespace {

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

const Schema& own() {
  static const Schema schema(own_types());
  return schema;
}

const Schema& every_kind() {
  static const Schema schema = [] {
    std::ostringstream text;
    text << std::ifstream(maploop::testing::source("tests/msgs/every_kind.lcm")).rdbuf();
    return schema_of(text.str());
  }();
  return schema;
}

template <class Lcm>
std::vector<std::uint8_t> encode(const Lcm& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(bytes.size()));
  return bytes;
}

std::map<std::string, std::string> fields(const DecodedMessage& message) {
  std::map<std::string, std::string> all;
  for (std::size_t node = 0; node < message.nodes().size(); ++node) {
    for (std::uint32_t i = 0; i < message.nodes()[node].count; ++i) {
      EXPECT_TRUE(all.emplace(message.path(node, i), message.text(node, i)).second);
    }
  }
  return all;
}

maploop_test_lcm::every_kind_t sample(int children) {
  maploop_test_lcm::every_kind_t m;
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
  m.names.resize(2);
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < m.medium; ++k) {
      m.names[static_cast<std::size_t>(i)].push_back(
          std::string(1, static_cast<char>('a' + 2 * i + k)));
    }
  }
  m.leaves.resize(2, std::vector<maploop_test_lcm::leaf_t>(2, m.leaf));
  m.leaves[1][0].n = 0;
  m.leaves[1][0].values.clear();
  for (int i = 0; i < 16; ++i) m.blob[i] = static_cast<std::uint8_t>(240 + i);
  if (children > 0) m.children.assign(static_cast<std::size_t>(children), sample(0));
  return m;
}

TEST(Schema, FingerprintsAreThoseOfTheGeneratedCode) {
  const std::map<std::string, std::int64_t> generated{
      {"maploop_lcm.header_t", maploop_lcm::header_t::getHash()},
      {"maploop_lcm.imu_t", maploop_lcm::imu_t::getHash()},
      {"maploop_lcm.gnss_fix_t", maploop_lcm::gnss_fix_t::getHash()},
      {"maploop_lcm.wheel_speed_t", maploop_lcm::wheel_speed_t::getHash()},
      {"maploop_lcm.nav_state_t", maploop_lcm::nav_state_t::getHash()},
      {"maploop_lcm.reference_pose_t", maploop_lcm::reference_pose_t::getHash()},
      {"maploop_lcm.preview_t", maploop_lcm::preview_t::getHash()},
      {"maploop_lcm.relative_motion_t", maploop_lcm::relative_motion_t::getHash()},
      {"maploop_lcm.lidar_motion_t", maploop_lcm::lidar_motion_t::getHash()},
      {"maploop_lcm.map_feedback_t", maploop_lcm::map_feedback_t::getHash()},
      {"maploop_lcm.map_match_t", maploop_lcm::map_match_t::getHash()},
      {"maploop_lcm.map_candidate_t", maploop_lcm::map_candidate_t::getHash()},
      {"maploop_lcm.latency_summary_t", maploop_lcm::latency_summary_t::getHash()},
      {"maploop_lcm.histogram_t", maploop_lcm::histogram_t::getHash()},
      {"maploop_lcm.missed_deadline_t", maploop_lcm::missed_deadline_t::getHash()},
      {"maploop_lcm.thread_health_t", maploop_lcm::thread_health_t::getHash()},
      {"maploop_lcm.ring_health_t", maploop_lcm::ring_health_t::getHash()},
      {"maploop_lcm.sensor_health_t", maploop_lcm::sensor_health_t::getHash()},
      {"maploop_lcm.deadlines_t", maploop_lcm::deadlines_t::getHash()},
      {"maploop_lcm.health_t", maploop_lcm::health_t::getHash()}};
  EXPECT_GE(own().types().size(), generated.size());
  for (const auto& [name, hash] : generated) {
    const Type* type = own().find(name);
    ASSERT_NE(type, nullptr) << name;
    EXPECT_EQ(type->fingerprint, static_cast<std::uint64_t>(hash)) << name;
    EXPECT_EQ(own().find(type->fingerprint), type);
  }
}

TEST(Schema, FingerprintOfATypeThatContainsItself) {
  const Type* type = every_kind().find("maploop_test_lcm.every_kind_t");
  ASSERT_NE(type, nullptr);
  EXPECT_EQ(type->fingerprint,
            static_cast<std::uint64_t>(maploop_test_lcm::every_kind_t::getHash()));
}

TEST(Schema, ConstantsAreKept) {
  const Type* type = own().find("maploop_lcm.nav_state_t");
  ASSERT_EQ(type->constants.size(), 3U);
  EXPECT_EQ(type->constants[2].name, "COASTING");
  EXPECT_EQ(type->constants[2].value, "2");
}

TEST(Schema, ErrorsNameFileLineAndWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"struct a {\n  int x;\n}", "a.lcm:2: the type 'int' is not known"},
      {"struct a {\n\n b.c_t x; }", "a.lcm:3: the type 'b.c_t' is not known"},
      {"struct a { int8_t x; int8_t x; }", "'x' is declared twice"},
      {"struct a { int8_t x }", "';' is missing before '}'"},
      {"struct a { double n; int8_t x[n]; }", "'n' sizes an array"},
      {"struct a { int8_t x[n]; int32_t n; }", "'n' sizes an array"},
      {"struct a { int8_t x[0]; }", "'0' is no size"},
      {"struct a { int8_t x[99999999999]; }", "is no size"},
      {"struct a { const int8_t X = 128; }", "'128' is no value of int8_t"},
      {"struct a { const string X = 1; }", "a constant is"},
      {"struct a { int8_t x;", "the end of the file"},
      {"struct a { int8_t 2x; }", "'2x' is no name"},
      {"enum a { B }", "enum is not supported"},
      {"package ..a;", "no package name"},
      {"/* no end", "comment has no end"},
      {"struct a { int8_t \x01; }", "'?' has no meaning"},
      {"int8_t x;", "'struct' or 'package' is missing"}};
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
  EXPECT_EQ(schema.types().size(), 3U);
  EXPECT_EQ(schema.find("p.a")->members[1].type, schema.find("q.c"));
  // The types differ only in name; LCM cannot distinguish them either.
  EXPECT_EQ(schema.find("q.c")->fingerprint, schema.find("p.b")->fingerprint);
}

TEST(Schema, TheSameTypeTwiceIsFineAnotherOfItsNameIsNot) {
  EXPECT_EQ(schema_of("struct a { int8_t x; } struct a { int8_t x; }").types().size(), 1U);
  EXPECT_NE(refusal("struct a { int8_t x; }\nstruct a { int8_t y; }").find("a.lcm:2: the type 'a'"),
            std::string::npos);
}

TEST(Schema, NestingThatDoublesWithEachLevelIsRefused) {
  std::string text = "struct t0 { int8_t x; }";
  for (int i = 1; i < 60; ++i) {
    const std::string below = "t" + std::to_string(i - 1);
    text += "struct t" + std::to_string(i) + " {" + below + " a; " + below + " b; }";
  }
  EXPECT_NE(refusal(text).find("nested too deeply"), std::string::npos);
}

TEST(Schema, DamagedTextNeverCrashes) {
  std::mt19937 random(20110926);
  std::ostringstream whole;
  whole << std::ifstream(maploop::testing::source("tests/msgs/every_kind.lcm")).rdbuf();
  int refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = whole.str();
    for (auto n = random() % 4; n > 0; --n) {
      text[random() % text.size()] = "{}[];,=/*0x._-\n\x80"[random() % 17];
    }
    text.erase(random() % text.size(), random() % 30);
    if (!refusal(text).empty()) ++refused;
  }
  EXPECT_GT(refused, 2000);
}

TEST(DecodedMessage, EveryKindOfFieldIsExact) {
  const auto bytes = encode(sample(1));
  DecodedMessage message;
  const auto error = message.decode(*every_kind().find(fingerprint_of(bytes)), bytes);
  ASSERT_FALSE(error) << error->reason;
  const auto all = fields(message);
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

TEST(DecodedMessage, NodesFormATree) {
  const auto bytes = encode(sample(2));
  DecodedMessage message;
  ASSERT_FALSE(message.decode(*every_kind().find(fingerprint_of(bytes)), bytes));
  const auto nodes = message.nodes();
  EXPECT_EQ(nodes[0].end, nodes.size());
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    EXPECT_LT(nodes[i].parent, i);
    EXPECT_LE(nodes[i].end, nodes[nodes[i].parent].end);
    EXPECT_GT(nodes[i].end, i);
  }
}

TEST(DecodedMessage, OwnTypeWithStringsAndNesting) {
  Health health;
  health.stamp = from_nanoseconds(1'317'042'651'174'740'000);
  health.threads.resize(1);
  health.threads[0].name = "fusion";
  health.threads[0].rate = 100.0;
  health.degraded = {"no real-time priority", ""};
  const auto bytes = encode(to_lcm(health));
  DecodedMessage message;
  ASSERT_FALSE(message.decode(*own().find("maploop_lcm.health_t"), bytes));
  const auto all = fields(message);
  EXPECT_EQ(all.at("utime"), "1317042651174740");
  EXPECT_EQ(all.at("threads[0].name"), "\"fusion\"");
  EXPECT_EQ(all.at("threads[0].rate_hz"), "100");
  EXPECT_EQ(all.at("degraded[0]"), "\"no real-time priority\"");
  EXPECT_EQ(all.at("degraded[1]"), "\"\"");
}

TEST(DecodedMessage, MessageCutAnywhereOrTooLongIsRefused) {
  auto bytes = encode(sample(1));
  const Type& type = *every_kind().find(fingerprint_of(bytes));
  DecodedMessage message;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto error = message.decode(type, std::span(bytes).first(size));
    ASSERT_TRUE(error) << size;
    EXPECT_FALSE(error->reason.empty());
    EXPECT_LE(error->offset, size);
    EXPECT_TRUE(message.nodes().empty());
  }
  bytes.push_back(0);
  EXPECT_EQ(message.decode(type, bytes)->reason, "1 bytes follow the last field");
}

TEST(DecodedMessage, HostileSizesAreRefusedByName) {
  const Schema schema = schema_of(
      "struct empty {}\n"
      "struct a { int64_t n; int64_t m; double x[n][m]; }\n"
      "struct b { int32_t n; empty x[n]; }\n"
      "struct c { c inner; }");
  const auto message_of = [](const Type& type, const std::vector<std::uint64_t>& words) {
    std::vector<std::uint8_t> bytes;
    for (const std::uint64_t word : words) {
      for (int shift = 56; shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<std::uint8_t>(word >> shift));
      }
    }
    for (int shift = 56; shift >= 0; shift -= 8) {
      bytes[static_cast<std::size_t>(7 - shift / 8)] =
          static_cast<std::uint8_t>(type.fingerprint >> shift);
    }
    return bytes;
  };
  const auto reason = [&](const char* name, const std::vector<std::uint64_t>& words,
                          std::size_t cut = 0) {
    const Type& type = *schema.find(name);
    auto bytes = message_of(type, words);
    bytes.resize(bytes.size() - cut);
    DecodedMessage message;
    const auto error = message.decode(type, bytes);
    return error ? error->reason : "";
  };
  constexpr std::uint64_t kMinusOne = ~std::uint64_t{0};
  EXPECT_EQ(reason("a", {0, kMinusOne, 1}), "'x': 'n' gives it the size -1");
  EXPECT_EQ(reason("a", {0, 1, kMinusOne}), "'x': 'm' gives it the size -1");
  for (const std::uint64_t huge : {1ULL << 31, 1ULL << 32, 1ULL << 33, 1ULL << 62}) {
    EXPECT_NE(reason("a", {0, huge, huge}), "");
    EXPECT_NE(reason("a", {0, huge, 1}), "");
    EXPECT_EQ(reason("a", {0, huge, 0}), "");  // no element at all
    EXPECT_EQ(reason("a", {0, 0, huge}), "");
  }
  EXPECT_EQ(reason("b", {0, 0x7fffffffULL << 32}, 4), "'x': more than 1000000 fields");
  EXPECT_EQ(reason("b", {0, 1000ULL << 32}, 4), "");
  EXPECT_NE(reason("c", {0}).find("nested too deeply"), std::string::npos);
}

TEST(DecodedMessage, FlippedBitsNeverCrashAndAcceptedValuesCanBeShown) {
  const auto whole = encode(sample(2));
  const Type& type = *every_kind().find(fingerprint_of(whole));
  std::mt19937 random(20110926);
  DecodedMessage message;
  int accepted = 0;
  for (int round = 0; round < 20000; ++round) {
    auto bytes = whole;
    for (auto n = 1 + random() % 3; n > 0; --n) {
      bytes[8 + random() % (bytes.size() - 8)] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    if (message.decode(type, bytes)) continue;
    ++accepted;
    EXPECT_GT(fields(message).size(), 20U);
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_LT(accepted, 20000);
}

TEST(ValueText, GivesTheSameBitsBack) {
  EXPECT_EQ(to_text(1.0 / 3.0), "0.3333333333333333");
  EXPECT_EQ(to_text(std::nan("")), "nan");
  EXPECT_EQ(to_text(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(to_text(16777216.0F), "16777216");
  EXPECT_EQ(to_text(std::string_view("a\x7f\0b", 4)), "\"a\\x7f\\x00b\"");
}

}  // namespace
}  // namespace maploop::schema
