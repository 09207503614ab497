// Explains why fixes of a track are not on a road of the map.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "mapmatch/map_area.h"
#include "msgs/frames.h"
#include "tools/match/match_output.h"

namespace maploop::match {
namespace {

using mapmatch::FixRefusal;

constexpr double beyond_the_map = 100.0;  // m from the map's area; no fix matches beyond it

constexpr auto not_a_number = "a value is not a number";
constexpr auto not_degrees = "not a latitude and a longitude in degrees";
constexpr auto outside = "outside of the map";

// Returns the reason of a refused fix.
std::string reason_of(const mapmatch::VehicleFix& fix, FixRefusal refusal) {
  const Geodetic& p = fix.position;
  if (std::abs(p.latitude) > radians(90.0) || std::abs(p.longitude) > radians(360.0))
    return not_degrees;
  return refusal == FixRefusal::not_finite ? not_a_number : std::string(to_string(refusal));
}

std::string remedy_of(const std::string& reason) {
  if (reason == not_degrees)
    return "are these metres, such as UTM's? Convert them to degrees of WGS84";
  if (reason == to_string(FixRefusal::not_later))
    return "does time run backwards? Sort the track by its time";
  return "correct or remove these rows of the track";
}

std::string places_of(const MatchedTrack& track) {
  mapmatch::GeographicBox box{180.0, 90.0, -180.0, -90.0};
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    if (track.results[i].refusal != FixRefusal::none) continue;
    const double latitude = degrees(track.fixes[i].position.latitude),
                 longitude = degrees(track.fixes[i].position.longitude);
    box = {std::min(box.west, longitude), std::min(box.south, latitude),
           std::max(box.east, longitude), std::max(box.north, latitude)};
  }
  return mapmatch::to_text(box);
}

}  // namespace

std::map<std::string, std::size_t> unused_fixes(const MatchedTrack& track,
                                                const mapmatch::RoadNetwork& network) {
  const mapmatch::GeographicBox area = mapmatch::area_of(network);
  std::map<std::string, std::size_t> counts;
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    const FixRefusal refusal = track.results[i].refusal;
    if (refusal != FixRefusal::none) {
      ++counts[reason_of(track.fixes[i], refusal)];
    } else if (!track.results[i].on_road &&
               !mapmatch::covers(area, track.fixes[i].position, beyond_the_map)) {
      ++counts[outside];
    }
  }
  return counts;
}

std::optional<std::string> why_unusable(const MatchedTrack& track,
                                        const mapmatch::RoadNetwork& network) {
  std::size_t refused = 0, on_road = 0;
  for (const mapmatch::MatchResult& r : track.results) {
    refused += r.refusal != FixRefusal::none;
    on_road += r.refusal == FixRefusal::none && r.on_road;
  }
  const std::size_t all = track.results.size();
  if (2 * refused > all) {
    std::string most;
    std::size_t count = 0;
    for (const auto& [reason, fixes] : unused_fixes(track, network)) {
      if (reason != outside && fixes > count) std::tie(most, count) = std::tie(reason, fixes);
    }
    return std::to_string(count) + " of " + std::to_string(all) +
           " fixes of the track cannot be used: " + most + "; " + remedy_of(most);
  }
  if (on_road > 0) return std::nullopt;
  return "no fix of the track is on a road of the map: the map covers " +
         mapmatch::to_text(mapmatch::area_of(network)) + ", and the track is at " +
         places_of(track) +
         "; is it the map of this place, and is the track's latitude not its longitude?";
}

}  // namespace maploop::match
