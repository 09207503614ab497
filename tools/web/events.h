// Makes events of a timeline from single moments.
#pragma once

#include <vector>

#include "tools/web/plot.h"

namespace maploop::web {

// Adds a moment to the last event if that is of the same level and section and ended at most `gap`
// seconds before, otherwise adds `kind` as an event at this moment. Returns the event.
Event& extend(std::vector<Event>& events, double second, double gap, const Event& kind);

// Sorts events by their beginning; those that begin together keep their order.
void sort_by_time(std::vector<Event>& events);

}  // namespace maploop::web
