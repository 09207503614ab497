// The loop of a stage with one input.
#pragma once

#include <cstdint>
#include <stop_token>

#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"

namespace maploop::vehicle {

// take(sample) for each, until the input is finished or stop is requested. save_until(t) comes when
// all up to t has been taken and nothing after it; promise(t) when no result up to t is to come:
// results are available `budget` after their sample.
template <class Sample, class Take, class SaveUntil, class Promise>
void take_each(runtime::Edge<Sample>& input, const runtime::Doorbell& bell, Duration budget,
               const std::stop_token& stop, Take&& take, SaveUntil&& save_until,
               Promise&& promise) {
  while (!stop.stop_requested()) {
    const std::uint32_t heard = bell.listen();
    const Time promised = input.promised();  // before the ring: see EdgeBase::promised()
    if (const Sample* sample = input.front()) {
      save_until(sample->available - Duration(1));
      take(*sample);
      input.pop();
      continue;
    }
    save_until(promised);
    if (promised == Time::max()) return;
    promise(promised + budget);
    bell.wait(heard);
  }
}

}  // namespace maploop::vehicle
