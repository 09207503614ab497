#include "tools/web/events.h"

#include <algorithm>

namespace maploop::web {

Event& extend(std::vector<Event>& events, double second, double gap, const Event& kind) {
  const bool follows = !events.empty() && events.back().section == kind.section &&
                       events.back().level == kind.level && second - events.back().to <= gap;
  if (!follows) {
    events.push_back(kind);
    events.back().from = second;
  }
  events.back().to = second;
  return events.back();
}

void sort_by_time(std::vector<Event>& events) {
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.from < b.from; });
}

}  // namespace maploop::web
