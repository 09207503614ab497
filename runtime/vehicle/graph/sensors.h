// The sensors that a vehicle is given, recorded or live.
#pragma once

#include <memory>
#include <optional>

#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "msgs/odometry.h"
#include "msgs/reference.h"
#include "msgs/wheel_speed.h"
#include "ppp/ppp_setup.h"
#include "runtime/vehicle/drivers/gnss_epoch.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/live_source.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// The sensors that the vehicle listens to; null: it does not have that sensor. GNSS is either fixes
// or observations.
struct LiveSensors {
  std::shared_ptr<const sensors::HostClock> clock;  // that they stamp with
  std::unique_ptr<sensors::LiveSource<StereoPair>> camera;
  std::unique_ptr<sensors::LiveSource<LidarScan>> velodyne;
  std::unique_ptr<sensors::LiveSource<ImuSample>> imu;
  std::unique_ptr<sensors::LiveSource<GnssFix>> gnss;
  std::unique_ptr<sensors::LiveSource<GnssEpoch>> epochs;             // as of Sensors
  std::unique_ptr<sensors::LiveSource<GnssCorrections>> corrections;  // for them
  std::shared_ptr<const ppp::PppSetup> ppp;
};

struct Sensors {
  std::unique_ptr<sensors::Source<StereoPair>> camera;
  std::unique_ptr<sensors::Source<LidarScan>> velodyne;
  std::unique_ptr<sensors::Source<ImuSample>> imu;
  std::unique_ptr<sensors::Source<GnssFix>> gnss;
  // In place of fixes: the receiver's observations, and the products that turn them into fixes.
  std::unique_ptr<sensors::Source<GnssEpoch>> epochs;
  std::shared_ptr<const ppp::PppSetup> ppp;
  std::unique_ptr<sensors::Source<WheelSpeed>> wheel;
  std::unique_ptr<sensors::Source<ReferencePose>> reference;
  // A recording without images has the motions that were fused, in place of the camera and of the
  // stereo and lidar threads; the other two are only shown.
  std::unique_ptr<sensors::Source<RelativeMotion>> odometry;
  std::unique_ptr<sensors::Source<RelativeMotion>> visual;
  std::unique_ptr<sensors::Source<LidarMotion>> lidar;
  // In place of all of these, on a live clock.
  std::optional<LiveSensors> live;

  // Calls f(source) for each recorded source that is not null.
  template <class F>
  void each_source(F&& f) {
    const auto there = [&f](auto& source) {
      if (source != nullptr) f(source);
    };
    there(camera);
    there(velodyne);
    there(imu);
    there(gnss);
    there(epochs);
    there(wheel);
    there(reference);
    there(odometry);
    there(visual);
    there(lidar);
  }
};

}  // namespace maploop::vehicle
