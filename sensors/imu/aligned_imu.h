// This file makes the samples in the vehicle's axes from those of a unit in any mount.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "sensors/imu/mount_alignment.h"
#include "sensors/source.h"

namespace maploop::sensors {

// A fix is used from the sample on that becomes available with it or later. Samples before the
// mount is known are left out and counted; `file` names them in the report, once.
class AlignedImu final : public Source<ImuSample> {
 public:
  static constexpr const char* not_yet_known = "the mount was not yet known";

  AlignedImu(std::unique_ptr<Source<SixAxisSample>> samples, std::unique_ptr<Source<GnssFix>> fixes,
             const MountParameters& parameters, double rear_axle_distance,
             std::filesystem::path file);

  bool next(ImuSample& sample) override;
  const SourceReport& report() const override { return report_; }

  const MountAlignment& alignment() const { return alignment_; }

 private:
  bool take(SixAxisSample& sample);

  std::unique_ptr<Source<SixAxisSample>> samples_;
  std::unique_ptr<Source<GnssFix>> fixes_;
  MountAlignment alignment_;
  std::filesystem::path file_;
  GnssFix fix_;
  bool has_fix_;
  std::uint64_t unaligned_ = 0;
  std::size_t passed_on_ = 0;  // findings of `samples_`
  SourceReport report_;
};

}  // namespace maploop::sensors
