// These tests use cameras as GStreamer pipelines: test pictures, recorded pictures, missing, ended
// and wrong ones.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "sensors/live/live_sensors.h"
#include "sensors/replay/kitti_drive.h"
#include "tests/sensors/live/lines.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::wait_for;

std::string test_pictures(int width, int height, const std::string& more = "") {
  return "videotestsrc is-live=true pattern=ball " + more +
         " ! video/x-raw,format=GRAY8,framerate=50/1,width=" + std::to_string(width) +
         ",height=" + std::to_string(height);
}

LiveStereoOptions options(std::string left, std::string right) {
  LiveStereoOptions o;
  o.left = std::move(left);
  o.right = std::move(right);
  o.width = 64;
  o.height = 48;
  return o;
}

TEST(LiveStereo, PairsTheImagesOfTwoCameras) {
  const HostClock clock;
  const auto cameras =
      listen_to_cameras(options(test_pictures(64, 48), test_pictures(64, 48)), clock);
  Time last = Time::min();
  for (int i = 0; i < 10; ++i) {
    StereoPair pair;
    ASSERT_TRUE(wait_for(*cameras, pair)) << cameras->report().connection.problem;
    EXPECT_EQ(pair.left.width, 64);
    EXPECT_EQ(pair.right.height, 48);
    EXPECT_GT(pair.stamp, last);
    EXPECT_GT(pair.available, pair.stamp);
    EXPECT_EQ(pair.sequence, static_cast<std::uint64_t>(i));
    last = pair.stamp;
  }
  const LiveReport report = cameras->report();
  EXPECT_TRUE(report.connection.open);
  EXPECT_EQ(report.delivered, 10u);
  EXPECT_THAT(report.notes, Not(Contains(HasSubstr("stamped on arrival"))));
}

TEST(LiveStereo, HalvesImagesThatHaveBothCameras) {
  const HostClock clock;
  auto two = options(test_pictures(128, 48, "pattern=gradient"), "");
  const auto one = listen_to_cameras(two, clock);
  StereoPair pair;
  ASSERT_TRUE(wait_for(*one, pair));
  EXPECT_EQ(pair.left.width, 64);
  EXPECT_EQ(pair.left.pixels, pair.right.pixels);  // a gradient from top to bottom
  two.delay = seconds(1);
  const auto late = listen_to_cameras(two, clock);
  ASSERT_TRUE(wait_for(*late, pair));
  EXPECT_GT(pair.available - pair.stamp, seconds(1));
}

TEST(LiveStereo, IsOpenedAgainWhereItEnds) {
  const HostClock clock;
  const auto camera =
      listen_to_cameras(options(test_pictures(128, 48, "num-buffers=3"), ""), clock);
  StereoPair pair;
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(wait_for(*camera, pair)) << i;
  EXPECT_EQ(camera->report().connection.opened, 3u);
}

TEST(LiveStereo, AMissingCameraIsNotAnErrorAndBlocksNothing) {
  const HostClock clock;
  const auto camera =
      listen_to_cameras(options("v4l2src device=/dev/no_camera", test_pictures(64, 48)), clock);
  StereoPair pair;
  EXPECT_FALSE(wait_for(*camera, pair, seconds(1)));
  const LiveReport report = camera->report();
  EXPECT_FALSE(report.connection.open);
  EXPECT_THAT(report.connection.problem, HasSubstr("/dev/no_camera"));
}

TEST(LiveStereo, CountsWhatItLeavesOut) {
  const HostClock clock;
  const auto wrong = listen_to_cameras(options(test_pictures(100, 48), ""), clock);
  StereoPair pair;
  EXPECT_FALSE(wait_for(*wrong, pair, milliseconds(500)));
  EXPECT_THAT(wrong->report().reasons, Contains(HasSubstr("pairs whose size differs")));
  auto never = options(test_pictures(64, 48), test_pictures(64, 48));
  never.max_skew = -seconds(1);
  const auto apart = listen_to_cameras(never, clock);
  EXPECT_FALSE(wait_for(*apart, pair, milliseconds(500)));
  EXPECT_THAT(apart->report().reasons, Contains(HasSubstr("images without a partner")));
}

TEST(LiveStereo, AnInvalidPipelineIsReportedBeforeItIsOpened) {
  const HostClock clock;
  for (const char* text :
       {"", "no_such_element", "videotestsrc ! ! x", "videotestsrc colour=red"}) {
    EXPECT_THROW(listen_to_cameras(options(text, ""), clock), std::invalid_argument) << text;
  }
  auto unknown = options(test_pictures(64, 48), "");
  unknown.width = 0;
  EXPECT_THROW(listen_to_cameras(unknown, clock), std::invalid_argument);
}

TEST(LiveStereo, RecordedPicturesComeThroughAsTheyAre) {
  MAPLOOP_REQUIRE_DRIVE();
  const auto drive = maploop::testing::drive_0013();
  const auto pictures = [&](const char* camera) {
    return "multifilesrc location=" + (drive / camera / "data/%010d.png").string() +
           " caps=image/png,framerate=10/1 ! pngdec ! identity sync=true";
  };
  LiveStereoOptions o;
  o.left = pictures("image_00");
  o.right = pictures("image_01");
  o.max_skew = milliseconds(49);
  const KittiDrive recorded(drive);
  o.width = recorded.calibration().stereo.width;
  o.height = recorded.calibration().stereo.height;
  const HostClock clock;
  const auto cameras = listen_to_cameras(o, clock);
  const auto source = recorded.camera();
  StereoPair live, file;
  ASSERT_TRUE(source->next(file));
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(wait_for(*cameras, live));
    // The pipelines start one after the other, so a first image may lack its partner.
    while (live.left.pixels != file.left.pixels) ASSERT_TRUE(source->next(file));
    EXPECT_EQ(live.right.pixels, file.right.pixels);
  }
}

}  // namespace
}  // namespace maploop::sensors
