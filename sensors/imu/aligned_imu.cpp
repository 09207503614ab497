#include "sensors/imu/aligned_imu.h"

#include <utility>

namespace maploop::sensors {

AlignedImu::AlignedImu(std::unique_ptr<Source<SixAxisSample>> samples,
                       std::unique_ptr<Source<GnssFix>> fixes, const MountParameters& parameters,
                       double rear_axle_distance, std::filesystem::path file)
    : samples_(std::move(samples)),
      fixes_(std::move(fixes)),
      alignment_(parameters, rear_axle_distance),
      file_(std::move(file)),
      has_fix_(fixes_ != nullptr && fixes_->next(fix_)) {}

bool AlignedImu::next(ImuSample& sample) {
  SixAxisSample six;
  while (take(six)) {
    if (alignment_.mount().known()) {
      sample = alignment_.aligned(six);
      ++report_.delivered;
      return true;
    }
    if (unaligned_++ == 0) report_.refusals.push_back({file_.string(), 0, not_yet_known});
    ++report_.refused;
  }
  return false;
}

// Reads the next sample, and shows it and the fixes before it to the alignment.
bool AlignedImu::take(SixAxisSample& sample) {
  const bool more = samples_->next(sample);
  const SourceReport& read = samples_->report();
  for (; passed_on_ < read.refusals.size(); ++passed_on_) {
    if (report_.refusals.size() < SourceReport::max_findings) {
      report_.refusals.push_back(read.refusals[passed_on_]);
    }
  }
  report_.refused = read.refused + unaligned_;
  if (!more) return false;
  for (; has_fix_ && fix_.available <= sample.available; has_fix_ = fixes_->next(fix_)) {
    alignment_.add(fix_);
  }
  alignment_.add(sample);
  return true;
}

}  // namespace maploop::sensors
