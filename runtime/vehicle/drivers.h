// The vehicle's sensor drivers, recorded or live.
#pragma once

#include <memory>

#include "runtime/vehicle/driver.h"
#include "runtime/vehicle/gnss_epoch.h"
#include "runtime/vehicle/vehicle.h"

namespace maploop::vehicle {

// Each is there; one without a sensor is absent().
struct Drivers {
  std::unique_ptr<Driver<StereoPair>> camera;
  std::unique_ptr<Driver<LidarScan>> velodyne;
  std::unique_ptr<Driver<ImuSample>> imu;
  std::unique_ptr<Driver<GnssFix>> gnss;
  std::unique_ptr<Driver<GnssEpoch>> epochs;  // instead of gnss where there are observations
  std::unique_ptr<Driver<GnssCorrections>> corrections;
  std::unique_ptr<Driver<WheelSpeed>> wheel;
  std::unique_ptr<Driver<ReferencePose>> reference;
  std::unique_ptr<Driver<RelativeMotion>> odometry;
  std::unique_ptr<Driver<RelativeMotion>> visual_log;
  std::unique_ptr<Driver<LidarMotion>> lidar_log;

  template <class F>
  void each(F&& f) {
    f(*camera);
    f(*velodyne);
    f(*imu);
    f(*gnss);
    f(*epochs);
    f(*corrections);
    f(*wheel);
    f(*reference);
    f(*odometry);
    f(*visual_log);
    f(*lidar_log);
  }
};

}  // namespace maploop::vehicle
