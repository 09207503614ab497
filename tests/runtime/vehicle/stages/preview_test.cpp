// Tests the pictures and scans for viewers: who gets them, and what they contain.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <maploop_lcm/preview_t.hpp>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "msgs/lcm/channel_names.h"
#include "runtime/vehicle/stages/preview_stage.h"
#include "sensors/image/jpeg.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/runtime/vehicle/memory_bus.h"

namespace maploop::vehicle {
namespace {

class LookersBus final : public MessageSink {
 public:
  std::string_view name() const override { return "lookers"; }
  bool wants_preview() const override { return true; }
  std::vector<maploop_lcm::preview_t> previews;

 private:
  bool take(const Message& message) override {
    if (message.channel != channel_names::preview) return true;
    const int size = static_cast<int>(message.data.size());
    return previews.emplace_back().decode(message.data.data(), 0, size) == size;
  }
};

bool has_thread(const VehicleReport& report, const std::string& name) {
  const auto& threads = report.health.threads;
  return std::any_of(threads.begin(), threads.end(),
                     [&](const ThreadHealth& t) { return t.name == name; });
}

VehicleReport drive_with(MessageSink& sink, const VehicleConfig& config, double speed) {
  return testing::drive({.sensors = testing::fake_sensors(2.0),
                         .speed = speed,
                         .config = config,
                         .sinks = {&sink}})
      .report;
}

TEST(Preview, ShowsThePictureAndTheScanToThoseWhoLook) {
  LookersBus bus;
  VehicleConfig config;
  config.preview.rate = 5.0;
  config.preview.width = 160;
  config.preview.points = 20;
  config.scheduling.preview.nice = 0;  // so that it also runs on a busy machine
  const VehicleReport report = drive_with(bus, config, 1.0);
  EXPECT_TRUE(has_thread(report, "preview"));
  ASSERT_FALSE(bus.previews.empty());
  const auto with_picture = std::find_if(bus.previews.begin(), bus.previews.end(),
                                         [](const auto& p) { return p.width > 0; });
  ASSERT_NE(with_picture, bus.previews.end());
  EXPECT_EQ(with_picture->width, 160);
  EXPECT_EQ(with_picture->height, 60);
  const GreyImage picture = sensors::decode_grey_jpeg(
      {reinterpret_cast<const char*>(with_picture->jpeg.data()), with_picture->jpeg.size()});
  EXPECT_EQ(picture.width, 160);
  EXPECT_EQ(picture.height, 60);
  const auto with_scan = std::find_if(bus.previews.begin(), bus.previews.end(),
                                      [](const auto& p) { return p.point_count > 0; });
  ASSERT_NE(with_scan, bus.previews.end());
  EXPECT_EQ(with_scan->point_count, 20);
}

TEST(Preview, IsNotMadeWhereNobodyLooksOrItsRateIsZero) {
  testing::MemoryBus log;
  EXPECT_FALSE(has_thread(drive_with(log, {}, 0.0), "preview"));
  for (const auto& kept : log.messages()) EXPECT_NE(kept.channel, channel_names::preview);
  LookersBus bus;
  VehicleConfig config;
  config.preview.rate = 0.0;
  EXPECT_FALSE(has_thread(drive_with(bus, config, 0.0), "preview"));
  EXPECT_TRUE(bus.previews.empty());
}

TEST(Preview, ThinsAScanToNoMoreThanIsAskedFor) {
  const std::vector<LidarPoint> points(1001, LidarPoint{1.0F, 2.0F, 3.0F, 0.5F});
  std::vector<LidarPoint> out;
  for (const std::size_t most : {0u, 1u, 2u, 100u, 1000u, 1001u, 5000u}) {
    thin(points, most, out);
    EXPECT_LE(out.size(), most);
    EXPECT_GE(out.size(), std::min<std::size_t>(most, points.size()) / 2) << most;
  }
  thin({}, 10, out);
  EXPECT_TRUE(out.empty());
}

TEST(Preview, APointThatIsFarOrNoNumberDoesNoHarm) {
  Rings rings(rings::all, {"preview", "publisher"}, {});
  runtime::Edge<Preview>& output = *rings.consumer(rings::preview_publisher);
  PreviewStage stage(rings, {}, Eigen::Isometry3d::Identity());
  std::jthread thread([&](const std::stop_token& stop) { stage.run(stop); });
  const Preview* preview = nullptr;
  for (int i = 0; i < 2000 && preview == nullptr; ++i) {
    stage.scan().offer([](PreviewScan& slot) {
      slot.stamp = from_nanoseconds(5);
      slot.points = {{1.0F, -2.0F, 0.5F, 0.0F},
                     {std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 0.0F},
                     {1e9F, -1e9F, 0.0F, 0.0F}};
    });
    std::this_thread::sleep_for(milliseconds(5));
    preview = output.front();
  }
  ASSERT_NE(preview, nullptr);
  ASSERT_EQ(preview->points.size(), 2u);
  EXPECT_EQ(preview->points[0].x, 100);
  EXPECT_EQ(preview->points[0].y, -200);
  EXPECT_EQ(preview->points[1].x, 32767);
  EXPECT_EQ(preview->points[1].y, -32767);
  EXPECT_EQ(preview->width, 0);
}

}  // namespace
}  // namespace maploop::vehicle
