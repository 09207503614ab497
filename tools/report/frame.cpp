#include "tools/report/frame.h"

namespace maploop::report {

Geodetic origin_of(const ReplayReport& r) {
  if (!r.track.states().empty()) return r.track.states().front().origin;
  if (!r.reference.empty()) return r.reference.front().position;
  for (const auto& [stamp, state] : r.ppp) {
    if (state.status != PppStatus::none) return state.position;
  }
  return {};
}

std::optional<sensors::ReferenceTrajectory> truth_of(const ReplayReport& r) {
  if (r.reference.size() < 2) return std::nullopt;
  return sensors::ReferenceTrajectory(r.reference, LocalFrame(origin_of(r)));
}

Time first_of(const ReplayReport& r) {
  if (!r.reference.empty()) return r.reference.front().stamp;
  if (!r.track.states().empty()) return r.track.states().front().stamp;
  return r.ppp.empty() ? Time{} : r.ppp.begin()->first;
}

}  // namespace maploop::report
