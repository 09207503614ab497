// This file makes sensors and the reference from the rows of an OXTS unit.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "msgs/gnss.h"
#include "msgs/imu.h"
#include "msgs/reference.h"
#include "msgs/wheel_speed.h"
#include "sensors/replay/gnss_aid.h"
#include "sensors/replay/oxts.h"
#include "sensors/replay/wheel_odometer.h"
#include "sensors/source.h"

namespace maploop::sensors {

// This is the part of a recording that is an OXTS unit's. The unit's position and attitude are
// valid at the stamp of their row; its rates, velocities and accelerations are valid a delay before
// it (measured on KITTI: about 60 ms). All are available at the stamp of the row. Every source
// reports every row that it could not use.
class OxtsRecording {
 public:
  bool has_oxts() const { return rows_ != nullptr; }

  // Each call returns a new source from the start of the recording, which may outlive it. Throws
  // std::runtime_error if the recording lacks the unit.

  // ImuSample has stamp = row's - delay, sequence = row.
  std::unique_ptr<Source<ImuSample>> imu() const;
  // GnssFix has stamp = row's, velocity_stamp = row's - delay, sequence = GnssAid's period.
  std::unique_ptr<Source<GnssFix>> gnss(const GnssAidParameters& parameters = {}) const;
  // WheelSpeed has stamp = row's - delay, sequence = row.
  std::unique_ptr<Source<WheelSpeed>> wheel(const WheelOdometerParameters& parameters = {}) const;
  // ReferencePose has stamp = row's, velocity_stamp = row's - delay, sequence = row.
  std::unique_ptr<Source<ReferencePose>> reference() const;

 protected:
  // `name` is that of the recording in errors.
  OxtsRecording(std::string name, Duration delay) : name_(std::move(name)), delay_(delay) {}
  ~OxtsRecording() = default;

  // `inertial` are rows of which only the inertial columns are filled, from which imu() is made.
  void set_rows(std::shared_ptr<const OxtsRows> rows, std::shared_ptr<const OxtsRows> inertial) {
    rows_ = std::move(rows);
    inertial_ = std::move(inertial);
  }

 private:
  template <class T, class Fill>
  std::unique_ptr<Source<T>> source(const std::shared_ptr<const OxtsRows>& rows, Fill fill) const;

  std::string name_;
  Duration delay_;
  std::shared_ptr<const OxtsRows> rows_;  // nullptr: none were recorded
  std::shared_ptr<const OxtsRows> inertial_;
};

}  // namespace maploop::sensors
