#include "sensors/replay/oxts_recording.h"

#include <cstddef>
#include <stdexcept>
#include <utility>

namespace maploop::sensors {
// Walks the rows. fill(row, stamp, sample) makes a sample from a usable row; it returns false if
// the row gives none.
template <class T, class Fill>
std::unique_ptr<Source<T>> OxtsRecording::source(const std::shared_ptr<const OxtsRows>& rows,
                                                 Fill fill) const {
  if (rows == nullptr) throw std::runtime_error("drive '" + name_ + "' has no folder oxts");
  return made<T>([rows, fill = std::move(fill), index = std::size_t{0}, unstamped = std::size_t{0}](
                     T& sample, SourceReport& report) mutable {
    while (index < rows->rows.size()) {
      const std::size_t i = index++;
      if (rows->verdicts[i]) {
        report.refuse(*rows->verdicts[i]);
        continue;
      }
      sample.available = rows->stamps[i];
      sample.sequence = i;
      if (fill(rows->rows[i], rows->stamps[i], sample)) return true;
    }
    for (; unstamped < rows->unstamped.size(); ++unstamped) {
      report.refuse(rows->unstamped[unstamped]);
    }
    return false;
  });
}

std::unique_ptr<Source<ImuSample>> OxtsRecording::imu() const {
  return source<ImuSample>(inertial_,
                           [delay = delay_](const OxtsRow& row, Time stamp, ImuSample& sample) {
                             sample.stamp = stamp - delay;
                             sample.values() = row.inertial;
                             return true;
                           });
}

std::unique_ptr<Source<GnssFix>> OxtsRecording::gnss(const GnssAidParameters& parameters) const {
  return source<GnssFix>(rows_, [delay = delay_, aid = GnssAid(parameters)](
                                    const OxtsRow& row, Time stamp, GnssFix& fix) mutable {
    fix.velocity_stamp = stamp - delay;
    return aid.offer(stamp, row.position, row.velocity_enu, fix);
  });
}

std::unique_ptr<Source<WheelSpeed>> OxtsRecording::wheel(
    const WheelOdometerParameters& parameters) const {
  return source<WheelSpeed>(rows_, [delay = delay_, odometer = WheelOdometer(parameters)](
                                       const OxtsRow& row, Time stamp, WheelSpeed& sample) {
    odometer.measure(stamp - delay, row.forward_speed, row.inertial.specific_force_forward,
                     row.position, sample);
    return true;
  });
}

std::unique_ptr<Source<ReferencePose>> OxtsRecording::reference() const {
  return source<ReferencePose>(
      rows_, [delay = delay_](const OxtsRow& row, Time stamp, ReferencePose& sample) {
        sample.stamp = stamp;
        sample.position = row.position;
        sample.attitude = row.attitude;
        sample.velocity_stamp = stamp - delay;
        sample.velocity_enu = row.velocity_enu;
        sample.position_accuracy = row.position_accuracy;
        return true;
      });
}

}  // namespace maploop::sensors
