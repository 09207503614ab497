// Names the samples that have a flow in a trace, from their release to the publication of the state
// that contains them, or for which they were refused. A sample has the same number everywhere.
#pragma once

#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/odometry.h"
#include "runtime/core/trace_event.h"
#include "runtime/vehicle/drivers/gnss_epoch.h"

namespace maploop::vehicle {

inline runtime::TraceFlow flow_of(const StereoPair& pair) {
  return {"camera", pair.sequence};
}
// A motion has the number of its image pair.
inline runtime::TraceFlow flow_of(const RelativeMotion& motion) {
  return {"camera", motion.sequence};
}
inline runtime::TraceFlow flow_of(const ImuSample& sample) {
  return {"imu", sample.sequence};
}
// A fix has the number of its epoch.
inline runtime::TraceFlow flow_of(const GnssEpoch& epoch) {
  return {"gnss", epoch.sequence};
}
inline runtime::TraceFlow flow_of(const GnssFix& fix) {
  return {"gnss", fix.sequence};
}

}  // namespace maploop::vehicle
