// This file replays a bag or an MCAP file (message_reader.h) as a vehicle's sensors.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/calibration.h"
#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/lidar_scan.h"
#include "msgs/wheel_speed.h"
#include "sensors/bag/bag_parameters.h"
#include "sensors/bag/topic_choice.h"
#include "sensors/camera/stereo_rig.h"
#include "sensors/imu/aligned_imu.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Describes the vehicle where the recording does not, or where something else is to be used.
struct BagVehicle {
  std::optional<StereoRig> cameras;         // of raw images
  std::filesystem::path lidar_calibration;  // of a scanner's packets; empty: that of its model
};

// These are the limits of a drive, as of KittiDriveParameters.
struct BagLimits {
  double camera_readout = 0.005, max_pair_skew = 0.020, max_turn = 0.250;  // s
};

struct BagSettings;  // bag_sources.h

// Which topic is which sensor is said by topic_choice.h. Stamps are those of the messages' headers,
// if they increase and if those of all chosen topics begin within an hour of each other, or else
// the times at which the recorder received the messages.
//
// The body frame has the origin of the inertial unit, where /tf or /tf_static place it. Its axes
// are those of base_link (base_footprint), if the transforms contain it; else the unit's, if they
// point forward (as the camera or the LiDAR does) and up; else the LiDAR's; else the camera's. A
// sensor without a transform is taken to look forward from the body's origin, and a note says so.
class BagRecording {
 public:
  // Reads the first messages of the chosen topics; `summary` is that of the recording
  // (summarize()). Throws std::runtime_error that names the recording and states what to do.
  BagRecording(const std::filesystem::path& path, BagSummary summary,
               const BagParameters& parameters, const BagVehicle& vehicle, const BagLimits& limits);
  ~BagRecording();

  const VehicleCalibration& calibration() const { return calibration_; }

  // These are sentences for the user: what is not used and why, and what was assumed.
  const std::vector<std::string>& notes() const { return notes_; }

  bool has(BagSensor sensor) const { return choice_.find(sensor) != nullptr; }

  // These are those of the images; if there are none, of the first that is there of clouds, fixes
  // and observations, whose times are those at which they were received.
  std::size_t frame_count() const { return frame_count_; }
  Time first_stamp() const { return first_stamp_; }
  Time last_stamp() const { return last_stamp_; }

  // Each call returns a new source from the start of the recording, which may outlive it and run on
  // its own thread; it throws std::logic_error if the recording does not have the sensor. Pixels
  // and points that are available up to `passed` are not converted.
  std::unique_ptr<Source<StereoPair>> camera(Time passed) const;
  std::unique_ptr<Source<LidarScan>> lidar(Time passed) const;
  std::unique_ptr<Source<GnssFix>> gnss() const;
  std::unique_ptr<Source<WheelSpeed>> wheel() const;

  // Returns the receiver's observations, with the subframes if there are any, as UBX. Adds a note
  // if messages were left out.
  std::string observations(std::vector<std::string>& notes) const;

  // The unit's mount is `given`, or else that of the transforms, or else found with `fixes`.
  std::unique_ptr<Source<ImuSample>> imu(std::unique_ptr<Source<GnssFix>> fixes,
                                         const MountParameters& given,
                                         double rear_axle_distance) const;

 private:
  struct Opening;
  void set_stamp_rule(const Opening& opening, BagSettings& settings);
  void open_camera(const std::filesystem::path& path);
  void open_body(const std::filesystem::path& path, const Opening& opening, BagSettings& settings);
  static void set_turn(const TopicSummary& clouds, BagSettings& settings);
  void find_span(const Opening& opening);

  std::shared_ptr<const BagSettings> settings_;
  TopicChoice choice_;
  std::vector<std::string> notes_;
  VehicleCalibration calibration_;
  MountParameters mount_;
  std::optional<StereoRig> raw_cameras_;
  std::size_t frame_count_ = 0;
  Time first_stamp_{}, last_stamp_{};
};

}  // namespace maploop::sensors
