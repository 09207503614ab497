// Tests streams of receivers in pieces: the result equals that of the file readers for the whole.
#include "ppp/readers/streams/receiver_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "ppp/gnss_files.h"
#include "ppp/readers/files/lines.h"
#include "tests/ppp/readers/streams/rtklib_encoder.h"
#include "tests/support/gnss_messages.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

const GpsTime long_before = gps_time({2015, 1, 1, 0, 0, 0.0});

std::filesystem::path samples() {
  return testing::real_data() / "gnss" / "parser_samples";
}

std::span<const std::uint8_t> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Pushes the bytes in pieces of 1 to `most` bytes.
std::vector<Epoch> pushed(ReceiverStream& stream, std::string_view bytes, std::size_t most) {
  std::mt19937 random(1);
  std::vector<Epoch> epochs;
  Epoch epoch;
  while (!bytes.empty()) {
    const std::size_t size = std::min<std::size_t>(bytes.size(), 1 + random() % most);
    stream.push(as_bytes(bytes.substr(0, size)));
    bytes.remove_prefix(size);
    while (stream.next(epoch)) epochs.push_back(epoch);
  }
  return epochs;
}

void expect_same(const std::vector<Epoch>& found, const std::vector<Epoch>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].time, expected[i].time);
    ASSERT_EQ(found[i].signals.size(), expected[i].signals.size());
    for (std::size_t k = 0; k < found[i].signals.size(); ++k) {
      const Signal &a = found[i].signals[k], &b = expected[i].signals[k];
      ASSERT_EQ(a.code, b.code);
      ASSERT_EQ(a.phase, b.phase);
      ASSERT_EQ(a.doppler, b.doppler);
      ASSERT_EQ(a.lost_lock, b.lost_lock);
    }
  }
}

TEST(ReceiverStream, GivesTheEpochsOfAFileOfUbx) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string bytes = read_file(samples() / "F9T-L2-5min.ubx.gz");
  const Observations file = parse_ubx(bytes, "F9T");
  for (const std::size_t most : {7UL, 1000UL, 100'000UL}) {
    ReceiverStream stream(long_before);
    expect_same(pushed(stream, bytes, most), file.epochs);
    EXPECT_EQ(stream.counts().damaged, 0u);
    EXPECT_EQ(stream.counts().unusable, 0u);
    EXPECT_GT(stream.counts().ubx, 2000u);
  }
}

// The week of `now` is wrong by years until an ephemeris gives the right one.
TEST(ReceiverStream, GivesTheEpochsOfAFileOfRtcm) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MAPLOOP_REQUIRE_RTKLIB();
  const testing::TemporaryFolder folder;
  const auto ubx = folder.path() / "F9T.ubx";
  std::ofstream(ubx, std::ios::binary) << read_file(samples() / "F9T-L2-5min.ubx.gz");
  const std::string encoded = testing::encoded_by_rtklib(ubx, "1077(1),1087(1),1097(1),1127(1)");
  ASSERT_FALSE(encoded.empty());
  const int week = gps_week(parse_ubx(read_file(ubx), "F9T").epochs.front().time);
  const std::string bytes = testing::gps_week_frame(week) + encoded;
  const Observations file = parse_rtcm3(bytes, "F9T");
  for (const std::size_t most : {7UL, 1000UL}) {
    ReceiverStream stream(long_before);
    std::vector<Epoch> found = pushed(stream, bytes, most);
    // Only the file's reader knows that the last epoch is complete.
    ASSERT_GE(found.size() + 1, file.epochs.size());
    expect_same(found,
                {file.epochs.begin(), file.epochs.begin() + static_cast<long>(found.size())});
    EXPECT_EQ(stream.counts().damaged, 0u);
  }
}

TEST(ReceiverStream, TakesEphemeridesOfOneKindWithObservationsOfTheOther) {
  MAPLOOP_REQUIRE_REAL_DATA();
  GnssFiles files;
  read_into(testing::real_data() / "gnss/kamakura_kinematic/SEPT265G.21O.gz", files);
  read_into(testing::real_data() / "gnss/kamakura_kinematic/SEPT2650.21P.gz", files);
  std::string bytes = "$GNGGA, other text of the receiver\r\n";
  std::size_t messages = 0;
  for (const KeplerMessage& m : files.navigation[0].kepler) {
    const std::string frame = testing::rtcm_ephemeris(m);
    messages += !frame.empty();
    bytes += frame;
  }
  for (int i = 0; i < 3; ++i)
    bytes += testing::rawx_frame(files.observations[0].epochs[static_cast<std::size_t>(i)]);
  ReceiverStream stream(files.observations[0].epochs[0].time);
  const auto epochs = pushed(stream, bytes, 50);
  ASSERT_EQ(epochs.size(), 3u);
  EXPECT_EQ(epochs[0].time, files.observations[0].epochs[0].time);
  ASSERT_EQ(stream.navigation().kepler.size(), messages);
  EXPECT_EQ(stream.counts().rtcm, messages);
}

TEST(ReceiverStream, PassesOverGarbageAndGoesOnAfterIt) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string bytes = read_file(samples() / "F9T-L2-5min.ubx.gz");
  const std::size_t half = bytes.size() / 2;
  std::mt19937 random(2);
  std::string garbage(300'000, '\0');
  for (char& c : garbage) c = static_cast<char>(random());
  garbage += "\xb5\x62\x02\x15\xff\xff";  // a frame of 65 kB
  ReceiverStream stream(long_before);
  const auto epochs = pushed(stream, bytes.substr(0, half) + garbage + bytes.substr(half), 1000);
  EXPECT_GE(epochs.size(), 297u);
  EXPECT_GT(stream.counts().damaged, 0u);
}

TEST(ReceiverStream, BeginsANewFrameAfterTheConnectionWasLost) {
  MAPLOOP_REQUIRE_REAL_DATA();
  GnssFiles files;
  read_into(testing::real_data() / "gnss/kamakura_kinematic/SEPT265G.21O.gz", files);
  const auto& epochs = files.observations[0].epochs;
  const std::string first = testing::rawx_frame(epochs[0]);
  ReceiverStream stream(epochs[0].time);
  EXPECT_EQ(pushed(stream, first.substr(0, 100), 10).size(), 0u);
  stream.restart();
  EXPECT_EQ(pushed(stream, testing::rawx_frame(epochs[1]), 10).size(), 1u);
  EXPECT_EQ(pushed(stream, first, 10).size(), 0u);  // the epoch is earlier than the last one
  EXPECT_EQ(stream.counts().repeated, 1u);
  EXPECT_EQ(stream.counts().damaged, 0u);
}

}  // namespace
}  // namespace maploop::ppp
