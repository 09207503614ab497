// Tests ephemerides inside a receiver's stream. Those of a RINEX file are sent as u-blox's
// subframes and read here and by RTKLIB; RTKLIB's encoding of them as RTCM 3 is read too.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "ppp/gnss_files.h"
#include "ppp/readers/files/broadcast_fields.h"
#include "ppp/readers/streams/receiver_stream.h"
#include "ppp/readers/streams/rtcm3_ephemeris.h"
#include "ppp/readers/streams/ubx_subframes.h"
#include "tests/ppp/readers/streams/rtklib_encoder.h"
#include "tests/support/gnss_messages.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

using std::chrono::hours;
using testing::BitWriter, testing::raw_bytes, testing::ubx_frame;

const GpsTime moment = gps_time({2020, 6, 25, 12, 10, 0.0});

// Makes an epoch with one code, which gives the time.
std::string rawx(GpsTime t) {
  std::string payload =
      raw_bytes(seconds_of_week(t)) + raw_bytes(static_cast<std::uint16_t>(gps_week(t)));
  payload += std::string{18, 1, 0, 0, 0, 0};
  payload += raw_bytes(2.2e7) + raw_bytes(1e8) + raw_bytes(0.0F) + std::string{0, 5, 0, 0} +
             raw_bytes(std::uint16_t{9000});
  payload += std::string{45, 1, 1, 1, 7, 0};
  return ubx_frame(0x02, 0x15, payload);
}

std::string sfrbx(int gnss, int satellite, int signal, int frequency,
                  const std::vector<std::uint32_t>& words) {
  std::string payload;
  for (const int value :
       {gnss, satellite, signal, frequency, static_cast<int>(words.size()), 0, 2, 0})
    payload += static_cast<char>(value);
  for (const std::uint32_t word : words) payload += raw_bytes(word);
  return ubx_frame(0x02, 0x13, payload);
}

BroadcastValues values_of(const KeplerMessage& m) {
  return testing::broadcast_values(m, gps_week(moment));
}

std::string gps_frames(const KeplerMessage& m) {
  const BroadcastValues values = values_of(m);
  const std::span<const BroadcastField> parts[3] = {broadcast_fields::gps_subframe_1,
                                                    broadcast_fields::gps_subframe_2,
                                                    broadcast_fields::gps_subframe_3};
  const auto issue = static_cast<std::uint64_t>(m.iode);
  std::string all;
  for (std::size_t i = 0; i < 3; ++i) {
    BitWriter bits;
    bits.put(0x8b, 8), bits.put(0, 16);
    bits.put(static_cast<std::uint64_t>(seconds_of_week(moment) / 6.0) + i + 1, 17);
    bits.put(0, 2), bits.put(i + 1, 3), bits.put(0, 2);
    bits.put(parts[i], values);
    bits.fill(240);
    // In subframes 1 and 3 the fields skip the issue, so it is inserted here.
    const std::size_t at = i == 0 ? 168 : 216;
    for (int k = 0; i != 1 && k < 8; ++k)
      bits.all[at + static_cast<std::size_t>(k)] = (issue >> (7 - k) & 1U) != 0;
    std::vector<std::uint32_t> words;
    for (std::size_t w = 0; w < 10; ++w)
      words.push_back(static_cast<std::uint32_t>(bits.number(24 * w, 24) << 6));
    all += sfrbx(0, m.satellite.number, 0, 0, words);
  }
  return all;
}

std::string galileo_page(int satellite, const BitWriter& word) {
  BitWriter even, odd, checked;
  even.put(0, 2), even.put(word.number(0, 56), 56), even.put(word.number(56, 56), 56);
  even.fill(128);
  odd.put(2, 2), odd.put(word.number(112, 16), 16), odd.fill(82);
  checked.put(0, 4);
  checked.all.insert(checked.all.end(), even.all.begin(), even.all.begin() + 114);
  checked.all.insert(checked.all.end(), odd.all.begin(), odd.all.end());
  odd.put(crc24q(checked.bytes()), 24);
  odd.fill(128);
  std::vector<std::uint32_t> words;
  for (const BitWriter* half : {&even, &odd}) {
    for (std::size_t i = 0; i < 4; ++i)
      words.push_back(static_cast<std::uint32_t>(half->number(32 * i, 32)));
  }
  return sfrbx(2, satellite, 1, 0, words);
}

std::string galileo_frames(const KeplerMessage& m) {
  const BroadcastValues values = values_of(m);
  const std::span<const BroadcastField> parts[5] = {
      broadcast_fields::galileo_word_1, broadcast_fields::galileo_word_2,
      broadcast_fields::galileo_word_3, broadcast_fields::galileo_word_4,
      broadcast_fields::galileo_word_5};
  const auto set = [](BitWriter& bits, std::size_t at, std::uint64_t value, int width) {
    for (int k = 0; k < width; ++k)
      bits.all[at + static_cast<std::size_t>(k)] = (value >> (width - 1 - k) & 1U) != 0;
  };
  std::string all;
  for (std::size_t type = 1; type <= 5; ++type) {
    BitWriter bits;
    bits.put(type, 6);
    bits.put(parts[type - 1], values);
    bits.fill(128);
    if (type >= 2 && type <= 4) set(bits, 6, static_cast<std::uint64_t>(m.iode), 10);
    if (type == 4) set(bits, 16, m.satellite.number, 6);
    all += galileo_page(m.satellite.number, bits);
  }
  return all;
}

std::string beidou_frames(const KeplerMessage& m) {
  const BroadcastValues values = values_of(m);
  const std::span<const BroadcastField> parts[3] = {broadcast_fields::beidou_subframe_1,
                                                    broadcast_fields::beidou_subframe_2,
                                                    broadcast_fields::beidou_subframe_3};
  std::string all;
  for (std::size_t i = 0; i < 3; ++i) {
    BitWriter bits;
    bits.put(0x712, 11), bits.put(0, 4), bits.put(i + 1, 3);
    bits.put(static_cast<std::uint64_t>(seconds_of_week(moment)) - 14 + 6 * i, 20);
    bits.put(parts[i], values);
    bits.fill(224);
    std::vector<std::uint32_t> words{static_cast<std::uint32_t>(bits.number(0, 26) << 4)};
    for (std::size_t w = 0; w < 9; ++w)
      words.push_back(static_cast<std::uint32_t>(bits.number(26 + 22 * w, 22) << 8));
    all += sfrbx(3, m.satellite.number, 0, 0, words);
  }
  return all;
}

std::string glonass_frames(const GlonassMessage& m) {
  BroadcastValues v{};
  const auto set = [&](Quantity q, double value) { v[static_cast<std::size_t>(q)] = value; };
  set(Quantity::x, m.position.x()), set(Quantity::y, m.position.y());
  set(Quantity::z, m.position.z()), set(Quantity::vx, m.velocity.x());
  set(Quantity::vy, m.velocity.y()), set(Quantity::vz, m.velocity.z());
  set(Quantity::ax, m.acceleration.x()), set(Quantity::ay, m.acceleration.y());
  set(Quantity::az, m.acceleration.z()), set(Quantity::tau, -m.minus_tau);
  set(Quantity::gamma, m.gamma), set(Quantity::health, m.health);
  const Time moscow = to_utc(m.toe) + std::chrono::hours(3);
  const auto day = std::chrono::floor<std::chrono::days>(moscow);
  set(Quantity::interval, static_cast<double>((moscow - day) / std::chrono::minutes(15)));
  const std::chrono::sys_days leap_year{std::chrono::year{2020} / 1 / 1};
  set(Quantity::day, static_cast<double>((day - leap_year).count() + 1));
  const std::span<const BroadcastField> parts[4] = {
      broadcast_fields::glonass_string_1, broadcast_fields::glonass_string_2,
      broadcast_fields::glonass_string_3, broadcast_fields::glonass_string_4};
  std::string all;
  for (std::size_t i = 0; i < 4; ++i) {
    BitWriter bits;
    bits.put(0, 1), bits.put(i + 1, 4);
    bits.put(parts[i], v);
    bits.fill(128);
    std::vector<std::uint32_t> words;
    for (std::size_t w = 0; w < 4; ++w)
      words.push_back(static_cast<std::uint32_t>(bits.number(32 * w, 32)));
    all += sfrbx(6, m.satellite.number, 0, m.channel + 7, words);
  }
  return all;
}

// Contains, for each satellite, the message nearest to the moment.
struct Sent {
  std::map<Satellite, KeplerMessage> kepler;
  std::map<Satellite, GlonassMessage> glonass;
  std::string ubx;
};

Sent send_real_messages() {
  Sent sent;
  const auto file = testing::real_data() / "gnss/esbc_static/ESBC00DNK_R_20201770000_01D_MN.rnx.gz";
  const NavigationFile all = parse_navigation(read_file(file), file.string());
  const auto nearer = [](const auto& m, const auto& before) {
    return std::chrono::abs(m.toe - moment) < std::chrono::abs(before.toe - moment);
  };
  for (const KeplerMessage& m : all.kepler) {
    const Satellite s = m.satellite;
    const bool geostationary = s.system == System::beidou && (s.number <= 5 || s.number >= 59);
    const bool f_nav =
        s.system == System::galileo && (static_cast<int>(m.data_sources) & 0x200) == 0;
    if (geostationary || f_nav || s.system == System::qzss) continue;
    if (const auto at = sent.kepler.find(s); at == sent.kepler.end() || nearer(m, at->second))
      sent.kepler[s] = m;
  }
  for (const GlonassMessage& m : all.glonass) {
    const auto at = sent.glonass.find(m.satellite);
    if (at == sent.glonass.end() || nearer(m, at->second)) sent.glonass[m.satellite] = m;
  }
  sent.ubx = rawx(moment);
  for (const auto& [satellite, m] : sent.kepler) {
    sent.ubx += satellite.system == System::gps       ? gps_frames(m)
                : satellite.system == System::galileo ? galileo_frames(m)
                                                      : beidou_frames(m);
  }
  for (const auto& [satellite, m] : sent.glonass) sent.ubx += glonass_frames(m);
  sent.ubx += rawx(moment + std::chrono::seconds(1));
  return sent;
}

// Expects all that was found to equal what was sent, to the units in which it was sent.
void compare(const Sent& sent, const NavigationFile& found, std::map<System, int>& count) {
  for (const KeplerMessage& m : found.kepler) {
    SCOPED_TRACE(to_string(m.satellite));
    ASSERT_TRUE(sent.kepler.contains(m.satellite));
    const KeplerMessage& s = sent.kepler.at(m.satellite);
    EXPECT_EQ(m.toe, s.toe);
    EXPECT_EQ(m.toc, s.toc);
    EXPECT_NEAR(m.af0, s.af0, 1.3e-10);
    EXPECT_NEAR(m.af1, s.af1, 1e-13);
    EXPECT_NEAR(m.m0, s.m0, 1e-9);
    EXPECT_NEAR(m.e, s.e, 1e-10);
    EXPECT_NEAR(m.sqrt_a, s.sqrt_a, 1e-6);
    EXPECT_NEAR(m.delta_n, s.delta_n, 3e-13);
    EXPECT_NEAR(m.omega0, s.omega0, 1e-9);
    EXPECT_NEAR(m.omega, s.omega, 1e-9);
    EXPECT_NEAR(m.i0, s.i0, 1e-9);
    EXPECT_NEAR(m.omega_dot, s.omega_dot, 3e-13);
    EXPECT_NEAR(m.i_dot, s.i_dot, 3e-13);
    EXPECT_NEAR(m.crs, s.crs, 0.02);
    EXPECT_NEAR(m.crc, s.crc, 0.02);
    EXPECT_NEAR(m.cuc, s.cuc, 1e-9);
    EXPECT_NEAR(m.cus, s.cus, 1e-9);
    EXPECT_NEAR(m.cic, s.cic, 1e-9);
    EXPECT_NEAR(m.cis, s.cis, 1e-9);
    EXPECT_NEAR(m.group_delay[0], s.group_delay[0], 3e-10);
    EXPECT_EQ(m.health, s.health);
    ++count[m.satellite.system];
  }
  for (const GlonassMessage& m : found.glonass) {
    SCOPED_TRACE(to_string(m.satellite));
    const GlonassMessage& s = sent.glonass.at(m.satellite);
    EXPECT_EQ(m.toe, s.toe);
    EXPECT_LT((m.position - s.position).norm(), 1.0);
    EXPECT_LT((m.velocity - s.velocity).norm(), 2e-3);
    EXPECT_LT((m.acceleration - s.acceleration).norm(), 2e-6);
    EXPECT_NEAR(m.minus_tau, s.minus_tau, 1e-9);
    EXPECT_NEAR(m.gamma, s.gamma, 1e-12);
    EXPECT_EQ(m.channel, s.channel);
    ++count[System::glonass];
  }
  EXPECT_EQ(found.refused, 0) << (found.refusals.empty() ? "" : found.refusals.front());
}

TEST(StreamEphemeris, SubframesGiveTheMessagesBack) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Sent sent = send_real_messages();
  GnssFiles files;
  ASSERT_EQ(parse_into(sent.ubx, "made.ubx", files), FileKind::ubx);
  ASSERT_EQ(files.navigation.size(), 1U);
  std::map<System, int> count;
  compare(sent, files.navigation.front(), count);
  EXPECT_EQ(files.navigation.front().kepler.size(), sent.kepler.size());
  EXPECT_EQ(files.navigation.front().glonass.size(), sent.glonass.size());
  EXPECT_GT(count[System::gps], 25);
  EXPECT_GT(count[System::galileo], 15);
  EXPECT_GT(count[System::beidou], 15);
  EXPECT_GT(count[System::glonass], 15);
}

TEST(StreamEphemeris, RtklibReadsTheSameSubframes) {
  MAPLOOP_REQUIRE_REAL_DATA();
  if (testing::run({"sh", "-c", "command -v convbin"}).status != 0)
    GTEST_SKIP() << "SKIPPED, NOT TESTED: RTKLIB's convbin is not installed";
  const testing::TemporaryFolder folder;
  const Sent sent = send_real_messages();
  const auto ubx = folder.path() / "made.ubx", rinex = folder.path() / "made.nav";
  std::ofstream(ubx, std::ios::binary) << sent.ubx;
  testing::run({"convbin", "-r", "ubx", "-v", "3.04", "-n", rinex.string(), "-o",
                (folder.path() / "made.obs").string(), ubx.string()});
  NavigationFile theirs = parse_navigation(read_file(rinex), "made.nav");
  theirs.glonass.clear();  // strings are sent without the Hamming code that RTKLIB requires
  std::map<System, int> count;
  compare(sent, theirs, count);
  EXPECT_GT(count[System::gps], 25);
  EXPECT_GT(count[System::beidou], 15);
}

TEST(StreamEphemeris, Rtcm3IsReadAsRtklibWritesIt) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MAPLOOP_REQUIRE_RTKLIB();
  const testing::TemporaryFolder folder;
  const Sent sent = send_real_messages();
  const auto ubx = folder.path() / "made.ubx";
  std::ofstream(ubx, std::ios::binary) << sent.ubx;
  NavigationFile theirs;
  const std::string bytes = testing::encoded_by_rtklib(ubx, "1019,1042");
  Rtcm3Frames frames(bytes);
  for (Rtcm3Message message; frames.next(message);) add_ephemeris(message, moment, theirs);
  std::map<System, int> count;
  compare(sent, theirs, count);
  EXPECT_GT(count[System::gps], 25);
  EXPECT_GT(count[System::beidou], 15);
}

// Makes subframe 4, page 18: the identifiers 1 and 56, then values in their own units.
std::string gps_ionosphere_frame(const std::array<int, 8>& units) {
  BitWriter bits;
  bits.put(0x8b, 8), bits.put(0, 16);
  bits.put(static_cast<std::uint64_t>(seconds_of_week(moment) / 6.0) + 4, 17);
  bits.put(0, 2), bits.put(4, 3), bits.put(0, 2);
  bits.put(1, 2), bits.put(56, 6);
  for (const int unit : units) bits.put(static_cast<std::uint64_t>(unit), 8);
  bits.fill(240);
  std::vector<std::uint32_t> words;
  for (std::size_t w = 0; w < 10; ++w)
    words.push_back(static_cast<std::uint32_t>(bits.number(24 * w, 24) << 6));
  return sfrbx(0, 5, 0, 0, words);
}

std::string galileo_ionosphere_page(int a0, int a1, int a2) {
  BitWriter bits;
  bits.put(5, 6);
  bits.put(static_cast<std::uint64_t>(a0), 11), bits.put(static_cast<std::uint64_t>(a1), 11);
  bits.put(static_cast<std::uint64_t>(a2), 14);
  bits.fill(128);
  return galileo_page(11, bits);
}

const std::array<int, 8> said{5, 2, -1, -2, 40, 6, -1, -8};
const Klobuchar heard{{5.0 / (1 << 30), 2.0 / (1 << 27), -1.0 / (1 << 24), -2.0 / (1 << 24),
                       40.0 * 2048, 6.0 * 16384, -65536.0, -8.0 * 65536}};

// The satellites have no ephemeris. The subframes are read from a recording and from a stream.
TEST(StreamEphemeris, SubframesGiveTheIonosphere) {
  const std::string again = gps_ionosphere_frame(said) + galileo_ionosphere_page(113, 2, 330);
  const std::string bytes = rawx(moment) + again + again +
                            gps_ionosphere_frame({0, 0, 0, 0, 0, 0, 0, 0}) +
                            rawx(moment + std::chrono::seconds(1));
  const IonisationLevel level{{28.25, 2.0 / 256, 330.0 / 32768}};
  const auto check = [&](const NavigationFile& found) {
    ASSERT_EQ(found.ionosphere.size(), 2U);
    EXPECT_EQ(found.ionosphere[0].coefficients, IonosphereCoefficients(heard));
    EXPECT_EQ(found.ionosphere[1].coefficients, IonosphereCoefficients(level));
    EXPECT_EQ(found.ionosphere[0].first, moment);
    EXPECT_EQ(found.refused, 0);
  };
  GnssFiles files;
  ASSERT_EQ(parse_into(bytes, "made.ubx", files), FileKind::ubx);
  ASSERT_EQ(files.navigation.size(), 1U);
  check(files.navigation.front());
  ReceiverStream stream(moment);
  stream.push({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  Epoch epoch;
  while (stream.next(epoch)) {
  }
  check(stream.navigation());
  BroadcastMessages taken;
  taken.take(stream.navigation());
  EXPECT_EQ(taken.ionosphere.size(), 2U);
  EXPECT_TRUE(stream.navigation().ionosphere.empty());
}

TEST(StreamEphemeris, RtklibReadsTheSameIonosphere) {
  MAPLOOP_REQUIRE_REAL_DATA();
  if (testing::run({"sh", "-c", "command -v convbin"}).status != 0)
    GTEST_SKIP() << "SKIPPED, NOT TESTED: RTKLIB's convbin is not installed";
  const testing::TemporaryFolder folder;
  const auto ubx = folder.path() / "made.ubx", rinex = folder.path() / "made.nav";
  std::ofstream(ubx, std::ios::binary)
      << send_real_messages().ubx << gps_ionosphere_frame(said) << rawx(moment + hours(1));
  testing::run({"convbin", "-oi", "-r", "ubx", "-v", "3.04", "-n", rinex.string(), "-o",
                (folder.path() / "made.obs").string(), ubx.string()});
  const NavigationFile theirs = parse_navigation(read_file(rinex), "made.nav");
  ASSERT_EQ(theirs.ionosphere.size(), 1U);
  const auto& values = std::get<Klobuchar>(theirs.ionosphere[0].coefficients).values;
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(values[i], heard.values[i], 1e-4 * std::abs(heard.values[i]));
}

// The encoder uses the same fields, so this shows that none is missing, but not their places.
TEST(StreamEphemeris, GalileosMessagesGiveTheMessagesBack) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Sent sent = send_real_messages();
  NavigationFile found;
  for (const auto& [satellite, m] : sent.kepler) {
    if (satellite.system != System::galileo) continue;
    BitWriter bits;
    bits.put(1046, 12), bits.put(satellite.number, 6);
    const BroadcastValues values = values_of(m);
    bits.put(broadcast_fields::rtcm_galileo, values),
        bits.put(broadcast_fields::rtcm_1046_end, values);
    EXPECT_EQ(bits.all.size(), 502U);  // the standard has 504 with two reserved ones
    bits.put(0, 2);
    const std::string payload = bits.bytes();
    EXPECT_TRUE(add_ephemeris({1046, payload, 0}, moment, found));
  }
  std::map<System, int> count;
  compare(sent, found, count);
  EXPECT_GT(count[System::galileo], 15);
}

TEST(StreamEphemeris, DamageIsRefusedOrWaitsForTheNext) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Sent sent = send_real_messages();
  // Without the second subframe no message is complete.
  SubframeCollector collector;
  NavigationFile found;
  UbxFrames frames(sent.ubx);
  int taken = 0;
  for (UbxFrame f; frames.next(f);) {
    if (f.id == 0x13 && taken++ % 3 == 1 && f.payload[0] == 0) continue;
    collector.add(f, moment, found);
  }
  for (const KeplerMessage& m : found.kepler) EXPECT_NE(m.satellite.system, System::gps);
  // Galileo's pages have a checksum, which is verified.
  std::string page = galileo_frames(sent.kepler.lower_bound({System::galileo, 1})->second);
  UbxFrames pages(page);
  UbxFrame f;
  ASSERT_TRUE(pages.next(f));
  std::string payload(f.payload);
  payload[12] = static_cast<char>(payload[12] ^ 1);
  const std::string again = ubx_frame(0x02, 0x13, payload);
  NavigationFile refused;
  UbxFrames damaged(again);
  ASSERT_TRUE(damaged.next(f));
  EXPECT_TRUE(SubframeCollector().add(f, moment, refused));
  EXPECT_EQ(refused.refused, 1);
  // The message is cut.
  NavigationFile cut;
  EXPECT_TRUE(add_ephemeris({1019, "\x3f\xb0\x50", 0}, moment, cut));
  EXPECT_EQ(cut.refused, 1);
  EXPECT_FALSE(add_ephemeris({1077, "\x3f\xb0\x50", 0}, moment, cut));
}

}  // namespace
}  // namespace maploop::ppp
