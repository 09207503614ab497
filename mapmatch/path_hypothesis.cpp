#include "mapmatch/path_hypothesis.h"

namespace maploop::mapmatch {

PathPoint place_on_path(const RoadNetwork& network, const PathHypothesis& h, double s) {
  const double length = network.link(h.link.link).length;
  if (s > length && h.has_next) return {h.next, s - length, network.at(h.next, s - length)};
  if (s < 0.0 && h.has_previous) {
    const double before = network.link(h.previous.link).length + s;
    return {h.previous, before, network.at(h.previous, before)};
  }
  return {h.link, s, network.at(h.link, s)};
}

}  // namespace maploop::mapmatch
