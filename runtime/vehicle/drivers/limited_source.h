// Cuts a recording off at a given time.
#pragma once

#include <memory>
#include <utility>

#include "runtime/vehicle/graph/sensors.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// Each source ends with its last sample that is available by `end`.
inline void limit(Sensors& sensors, Time end) {
  sensors.each_source([end]<class T>(std::unique_ptr<sensors::Source<T>>& source) {
    source = sensors::derived(std::move(source), [end](sensors::Source<T>& all, T& sample) {
      return all.next(sample) && sample.available <= end;
    });
  });
}

}  // namespace maploop::vehicle
