// These tests read videos that GStreamer has written of images whose pixels are known.
#include "sensors/image/video_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "sensors/folder/folder_drive.h"
#include "sensors/folder/image_lists.h"
#include "sensors/live/gstreamer.h"
#include "tests/sensors/folder_forms.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;
using maploop::testing::error_of;
using maploop::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int width = 320, height = 240, count = 5;
constexpr Duration widest_skew = std::chrono::milliseconds(20);

void run(const std::string& description) {
  const auto pipeline = parse_pipeline(description, description);
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  const GstOwned<GstBus> bus(gst_element_get_bus(pipeline.get()));
  const GstOwned<GstMessage> end(
      gst_bus_timed_pop_filtered(bus.get(), 20 * GST_SECOND,
                                 static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS)));
  ASSERT_TRUE(end && GST_MESSAGE_TYPE(end.get()) == GST_MESSAGE_EOS) << description;
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
}

// Writes a video of a moving ball, whose pixels are kept as they are.
void write_video(const fs::path& file, int images = count, const std::string& encoder = "",
                 const std::string& format = "GRAY8") {
  run("videotestsrc pattern=ball num-buffers=" + std::to_string(images) +
      " ! video/x-raw,format=" + format + ",framerate=10/1,width=" + std::to_string(width) +
      ",height=" + std::to_string(height) + encoder +
      " ! matroskamux ! filesink location=" + file.string());
}

class Videos : public ::testing::Test {
 protected:
  fs::path folder() const { return folder_.path(); }
  void write_stamps(const std::string& name, int stamps = count) const {
    std::string text;
    for (int i = 0; i < stamps; ++i) text += "1403636579." + std::to_string(i) + '\n';
    write_text(folder() / name, text);
  }
  FolderDrive drive() const {
    DriveParts parts;
    parts.folder = folder();
    parts.images = find_images(folder(), widest_skew);
    parts.calibration.stereo.width = width;
    parts.calibration.stereo.height = height;
    return {std::move(parts), {}};
  }
  // Returns how many pairs the drive gives, and what its report says.
  std::pair<int, std::string> pairs() const {
    const auto camera = drive().camera();
    StereoPair pair;
    int found = 0;
    while (camera->next(pair)) ++found;
    std::string refused;
    for (const Finding& finding : camera->report().refusals)
      refused += finding.file + ": " + finding.reason + '\n';
    return {found, refused};
  }
  maploop::testing::TemporaryFolder folder_;
};

TEST_F(Videos, ImagesComeInOrderAndOnesLeftOutArePassed) {
  write_video(folder() / "a.mkv");
  VideoFile whole(folder() / "a.mkv"), part(folder() / "a.mkv");
  std::vector<GreyImage> images(count);
  for (std::size_t i = 0; i < count; ++i) ASSERT_TRUE(whole.read(i, images[i]));
  GreyImage image;
  EXPECT_FALSE(whole.read(count, image));
  EXPECT_EQ(images[0].width, width);
  EXPECT_EQ(images[0].height, height);
  EXPECT_NE(images[0].pixels, images[3].pixels);
  ASSERT_TRUE(part.read(3, image));
  EXPECT_EQ(image.pixels, images[3].pixels);
  EXPECT_THAT(error_of([&] { part.read(1, image); }), HasSubstr("passed already"));
}

TEST_F(Videos, ColourBecomesGrey) {
  write_video(folder() / "grey.mkv");
  write_video(folder() / "colour.avi", count, " ! jpegenc", "I420");
  VideoFile grey(folder() / "grey.mkv"), colour(folder() / "colour.avi");
  GreyImage a, b;
  ASSERT_TRUE(grey.read(2, a) && colour.read(2, b));
  double difference = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    difference += std::abs(a.pixels[i] - b.pixels[i]);
  EXPECT_LT(difference / static_cast<double>(a.pixels.size()), 1.0);
}

TEST_F(Videos, APairOfVideosWithStampsIsADrive) {
  write_video(folder() / "left.mkv");
  write_video(folder() / "right.mkv");
  write_stamps("left.txt");
  write_stamps("right.txt");
  const auto camera = drive().camera();
  VideoFile alone(folder() / "left.mkv");
  StereoPair pair;
  GreyImage image;
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_TRUE(camera->next(pair) && alone.read(i, image));
    EXPECT_EQ(pair.left.pixels, image.pixels);
    EXPECT_EQ(pair.right.pixels, image.pixels);
    EXPECT_EQ(pair.stamp, Time(std::chrono::milliseconds(1403636579000 + 100 * i)));
  }
  EXPECT_FALSE(camera->next(pair));
  EXPECT_EQ(camera->report().refused, 0U);
}

TEST_F(Videos, OneListOfStampsServesBothCameras) {
  write_video(folder() / "cam0.mkv");
  write_video(folder() / "cam1.mkv");
  EXPECT_THAT(error_of([&] { drive(); }), AllOf(HasSubstr("no stamps"), HasSubstr("cam0.txt")));
  write_stamps("times.txt");
  EXPECT_EQ(pairs().first, count);
}

TEST_F(Videos, MoreOrFewerImagesThanStampsAreReported) {
  write_video(folder() / "left.mkv");
  write_video(folder() / "right.mkv");
  write_stamps("times.txt", count + 1);
  auto [found, refused] = pairs();
  EXPECT_EQ(found, count);
  EXPECT_THAT(refused, AllOf(HasSubstr("left.mkv/5"), HasSubstr("ended before this image")));
  write_stamps("times.txt", count - 1);
  std::tie(found, refused) = pairs();
  EXPECT_EQ(found, count - 1);
  EXPECT_THAT(refused, AllOf(HasSubstr("left.mkv: has more images"), HasSubstr("right.mkv")));
}

TEST_F(Videos, WhatIsNoVideoIsRefusedWithItsReason) {
  EXPECT_THAT(error_of([&] { VideoFile{folder() / "none.mp4"}; }), HasSubstr("none.mp4"));
  write_text(folder() / "left.mp4", "this is a text");
  write_video(folder() / "right.mkv");
  write_stamps("times.txt");
  const auto [found, refused] = pairs();
  EXPECT_EQ(found, 0);
  EXPECT_THAT(refused, AllOf(HasSubstr("left.mp4/0"), HasSubstr("cannot be decoded")));
}

TEST_F(Videos, ACutVideoGivesWhatItHas) {
  write_video(folder() / "left.mkv");
  write_video(folder() / "right.mkv");
  fs::resize_file(folder() / "right.mkv", fs::file_size(folder() / "right.mkv") / 2);
  write_stamps("times.txt");
  const auto [found, refused] = pairs();
  EXPECT_GE(found, 1);
  EXPECT_LT(found, count);
  EXPECT_THAT(refused, HasSubstr("right.mkv"));
}

}  // namespace
}  // namespace maploop::sensors
