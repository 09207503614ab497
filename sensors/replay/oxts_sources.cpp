#include "sensors/replay/oxts_sources.h"

#include <cstddef>
#include <utility>

namespace maploop::sensors {
namespace {

// Walks the rows; the derived source makes a sample from a usable row.
template <class T>
class OxtsSource : public Source<T> {
 public:
  explicit OxtsSource(std::shared_ptr<const OxtsRows> rows) : rows_(std::move(rows)) {}

  bool next(T& sample) final {
    while (index_ < rows_->rows.size()) {
      const std::size_t i = index_++;
      if (rows_->verdicts[i]) {
        report_.refuse(*rows_->verdicts[i]);
        continue;
      }
      sample.available = rows_->stamps[i];
      sample.sequence = i;
      if (!fill(rows_->rows[i], rows_->stamps[i], sample)) continue;
      ++report_.delivered;
      return true;
    }
    for (; unstamped_ < rows_->unstamped.size(); ++unstamped_) {
      report_.refuse(rows_->unstamped[unstamped_]);
    }
    return false;
  }

  const SourceReport& report() const final { return report_; }

 private:
  // Returns false if the row gives no sample.
  virtual bool fill(const OxtsRow& row, Time stamp, T& sample) = 0;

  std::shared_ptr<const OxtsRows> rows_;
  std::size_t index_ = 0;
  std::size_t unstamped_ = 0;
  SourceReport report_;
};

class ImuSource final : public OxtsSource<ImuSample> {
 public:
  ImuSource(std::shared_ptr<const OxtsRows> rows, Duration delay)
      : OxtsSource(std::move(rows)), delay_(delay) {}

 private:
  bool fill(const OxtsRow& row, Time stamp, ImuSample& sample) override {
    sample.stamp = stamp - delay_;
    sample.specific_force_forward = row.specific_force_forward;
    sample.specific_force_left = row.specific_force_left;
    sample.yaw_rate = row.yaw_rate;
    return true;
  }

  Duration delay_;
};

class GnssSource final : public OxtsSource<GnssFix> {
 public:
  GnssSource(std::shared_ptr<const OxtsRows> rows, Duration delay,
             const GnssAidParameters& parameters)
      : OxtsSource(std::move(rows)), delay_(delay), aid_(parameters) {}

 private:
  bool fill(const OxtsRow& row, Time stamp, GnssFix& sample) override {
    sample.velocity_stamp = stamp - delay_;
    return aid_.offer(stamp, row.position, row.velocity_enu, sample);
  }

  Duration delay_;
  GnssAid aid_;
};

class WheelSource final : public OxtsSource<WheelSpeed> {
 public:
  WheelSource(std::shared_ptr<const OxtsRows> rows, Duration delay,
              const WheelOdometerParameters& parameters)
      : OxtsSource(std::move(rows)), delay_(delay), odometer_(parameters) {}

 private:
  bool fill(const OxtsRow& row, Time stamp, WheelSpeed& sample) override {
    odometer_.measure(stamp - delay_, row.forward_speed, row.specific_force_forward, row.position,
                      sample);
    return true;
  }

  Duration delay_;
  WheelOdometer odometer_;
};

class ReferenceSource final : public OxtsSource<ReferencePose> {
 public:
  ReferenceSource(std::shared_ptr<const OxtsRows> rows, Duration delay)
      : OxtsSource(std::move(rows)), delay_(delay) {}

 private:
  bool fill(const OxtsRow& row, Time stamp, ReferencePose& sample) override {
    sample.stamp = stamp;
    sample.position = row.position;
    sample.attitude = row.attitude;
    sample.velocity_stamp = stamp - delay_;
    sample.velocity_enu = row.velocity_enu;
    sample.position_accuracy = row.position_accuracy;
    return true;
  }

  Duration delay_;
};

}  // namespace

std::unique_ptr<Source<ImuSample>> make_imu_source(std::shared_ptr<const OxtsRows> rows,
                                                   Duration delay) {
  return std::make_unique<ImuSource>(std::move(rows), delay);
}

std::unique_ptr<Source<GnssFix>> make_gnss_source(std::shared_ptr<const OxtsRows> rows,
                                                  Duration delay,
                                                  const GnssAidParameters& parameters) {
  return std::make_unique<GnssSource>(std::move(rows), delay, parameters);
}

std::unique_ptr<Source<WheelSpeed>> make_wheel_source(std::shared_ptr<const OxtsRows> rows,
                                                      Duration delay,
                                                      const WheelOdometerParameters& parameters) {
  return std::make_unique<WheelSource>(std::move(rows), delay, parameters);
}

std::unique_ptr<Source<ReferencePose>> make_reference_source(std::shared_ptr<const OxtsRows> rows,
                                                             Duration delay) {
  return std::make_unique<ReferenceSource>(std::move(rows), delay);
}

}  // namespace maploop::sensors
