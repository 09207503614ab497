// How far the fused state is from the fixes that made outages took away: an accuracy of drives that
// have no other truth.
#pragma once

#include <optional>
#include <vector>

#include "msgs/gnss.h"
#include "msgs/reference.h"
#include "runtime/vehicle/drivers/gnss_outage.h"
#include "tools/replay/fusion_score.h"

namespace maploop::fusion_score {

// At the last fix of an outage, horizontal. The fix's own error is a part of it.
struct OutageEnd {
  double start = 0.0, length = 0.0;  // s into the drive, s
  double distance = 0.0;             // m along the fixes, from the last one before the outage
  double error = 0.0;                // m
  double sigma = 0.0;                // m, of the state and the fix together, root of the trace
  std::optional<double> peer;        // m, of the reference at the same time, if there is one

  double percent() const { return distance > 0.0 ? 100.0 * error / distance : 0.0; }
};

// `fixes` are all of the recording, in order. An outage is left out where the filter had not
// started before it, or where it has no fix.
std::vector<OutageEnd> outage_ends(const NavTrack& track, const std::vector<GnssFix>& fixes,
                                   const std::vector<ReferencePose>& reference,
                                   const std::vector<vehicle::GnssOutage>& outages, Time origin);

}  // namespace maploop::fusion_score
