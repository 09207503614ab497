#include "msgs/lcm/conversions.h"
#include "msgs/lcm/field_copy.h"

namespace maploop {

void convert(auto copy, Is<MatchCandidate> auto& c, auto& m) {
  copy(c.link.link, m.link);
  copy(c.link.forward, m.forward);
  copy(c.way_id, m.way_id);
  copy(c.node_a, m.node_a);
  copy(c.node_b, m.node_b);
  copy(c.along, m.along);
  copy(c.distance, m.distance);
  copy(c.azimuth_error, m.azimuth_error);
  copy(c.connectivity, m.connectivity);
  copy(c.distance_error, m.distance_error);
  copy.choice(c.rules, m.rule_base, "map_candidate_t.rule_base");
  copy(c.decided, m.decided);
  copy(c.likelihood, m.likelihood);
  copy(c.weights, m.weights);
  copy(c.probability, m.probability);
}

// The candidates are the first `candidate_count` of an array.
void convert_candidates(auto copy, auto& match, auto& m) {
  if constexpr (copy.to_message) {
    m.candidates.resize(match.candidate_count);
    m.candidate_count = static_cast<std::int32_t>(match.candidate_count);
  } else {
    if (m.candidates.size() > match.candidates.size()) {
      throw std::invalid_argument("map_match_t has " + std::to_string(m.candidates.size()) +
                                  " candidates, more than this version holds");
    }
    match.candidate_count = m.candidates.size();
  }
  for (std::size_t i = 0; i < match.candidate_count; ++i) {
    convert(copy, match.candidates[i], m.candidates[i]);
  }
}

void convert(auto copy, Is<MapMatch> auto& match, auto& m) {
  copy.header(match, m.header);
  copy.choice(match.phase, m.phase, "map_match_t.phase");
  copy.choice(match.refusal, m.refusal, "map_match_t.refusal");
  copy(match.on_road, m.on_road);
  copy(match.probability, m.p_link);
  copy(match.margin, m.margin);
  copy(match.off_road, m.p_off_road);
  copy(match.likelihood, m.likelihood);
  copy(match.link.link, m.link);
  copy(match.link.forward, m.forward);
  copy(match.way_id, m.way_id);
  copy(match.node_a, m.node_a);
  copy(match.node_b, m.node_b);
  copy.place(match.origin, m.origin_latitude, m.origin_longitude, m.origin_height);
  copy(match.vehicle_enu, m.vehicle_enu);
  copy(match.covariance, m.covariance);
  copy(match.vehicle_azimuth, m.vehicle_azimuth);
  copy(match.speed, m.speed);
  copy(match.matched_enu, m.matched_enu);
  copy(match.sigma_along, m.sigma_along);
  copy(match.sigma_across, m.sigma_across);
  copy(match.link_azimuth, m.link_azimuth);
  copy(match.cross_track, m.cross_track);
  copy(match.half_width, m.half_width);
  copy(match.lane.lanes, m.lanes);
  copy(match.lane.lane, m.lane);
  copy(match.lane.probability, m.p_lane);
  copy(match.lane.offset, m.lane_offset);
  copy(match.bend, m.bend);
  copy(match.along, m.along);
  copy(match.to_junction, m.to_junction);
  convert_candidates(copy, match, m);
}

maploop_lcm::map_match_t to_lcm(const MapMatch& match, const MapMatchWords& words) {
  maploop_lcm::map_match_t m{};
  const FieldCopy<true> copy;
  convert(copy, match, m);
  m.explanation = words.explanation;
  for (std::size_t i = 0; i < std::min(m.candidates.size(), words.candidates.size()); ++i) {
    const MapMatchWords::Candidate& said = words.candidates[i];
    m.candidates[i].road = said.road;
    copy.each(said.rules, m.candidates[i].rules, m.candidates[i].rule_count);
    copy.each(said.objections, m.candidates[i].objections, m.candidates[i].objection_count);
  }
  return m;
}

MapMatch from_lcm(const maploop_lcm::map_match_t& message) {
  MapMatch match;
  convert(FieldCopy<false>{}, match, message);
  return match;
}

void convert_track(auto copy, auto& doubt, auto& m) {
  if constexpr (copy.to_message) {
    m.point_count = static_cast<std::int32_t>(doubt.track_count);
    m.latitude.resize(doubt.track_count);
    m.longitude.resize(doubt.track_count);
  } else {
    if (m.latitude.size() > doubt.track.size()) {
      throw std::invalid_argument("map_doubt_t has " + std::to_string(m.latitude.size()) +
                                  " points, more than this version holds");
    }
    doubt.track_count = m.latitude.size();
  }
  for (std::size_t i = 0; i < doubt.track_count; ++i) {
    copy(doubt.track[i].latitude, m.latitude[i]);
    copy(doubt.track[i].longitude, m.longitude[i]);
  }
}

void convert(auto copy, Is<MapDoubt> auto& doubt, auto& m) {
  copy.header(doubt, m.header);
  copy.choice(doubt.kind, m.kind, "map_doubt_t.kind");
  if constexpr (copy.to_message) m.explanation = to_string(doubt.kind);
  copy(doubt.begin, m.begin_ns);
  copy(doubt.probability, m.probability);
  copy(doubt.length, m.length);
  copy(doubt.from.link.link, m.link);
  copy(doubt.from.link.forward, m.forward);
  copy(doubt.from.way_id, m.way_id);
  copy(doubt.from.node_a, m.node_a);
  copy(doubt.from.node_b, m.node_b);
  copy(doubt.to.link.link, m.to_link);
  copy(doubt.to.link.forward, m.to_forward);
  copy(doubt.to.way_id, m.to_way_id);
  copy(doubt.to.node_a, m.to_node_a);
  copy(doubt.to.node_b, m.to_node_b);
  copy(doubt.offset, m.offset);
  copy(doubt.offset_sigma, m.offset_sigma);
  convert_track(copy, doubt, m);
}
MAPLOOP_CONVERSIONS(MapDoubt, maploop_lcm::map_doubt_t)

void convert(auto copy, Is<MapFeedback> auto& feedback, auto& m) {
  copy.header(feedback, m.header);
  copy.choice(feedback.reason, m.reason, "map_feedback_t.reason");
  if constexpr (copy.to_message) m.explanation = to_string(feedback.reason);
  copy(feedback.position, m.position);
  copy(feedback.azimuth, m.azimuth);
  copy(feedback.reset, m.reset);
  copy(feedback.new_road, m.new_road);
  copy(feedback.off_ground, m.off_ground);
  copy.place(feedback.point, m.latitude, m.longitude, m.height);
  copy(feedback.link_azimuth, m.link_azimuth);
  copy(feedback.cross_track, m.cross_track);
  copy(feedback.cross_sigma, m.cross_sigma);
  copy(feedback.lane_sigma, m.lane_sigma);
  copy(feedback.azimuth_sigma, m.azimuth_sigma);
  copy(feedback.probability, m.probability);
}
MAPLOOP_CONVERSIONS(MapFeedback, maploop_lcm::map_feedback_t)

}  // namespace maploop
