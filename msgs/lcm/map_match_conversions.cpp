#include "msgs/lcm/conversion_parts.h"
#include "msgs/lcm/conversions.h"

namespace maploop {
namespace {

maploop_lcm::map_candidate_t to_lcm(const MatchCandidate& c) {
  maploop_lcm::map_candidate_t m{};
  m.link = c.link.link;
  m.forward = c.link.forward;
  m.way_id = c.way_id;
  m.node_a = c.node_a;
  m.node_b = c.node_b;
  m.along = c.along;
  m.distance = c.distance;
  m.azimuth_error = c.azimuth_error;
  m.connectivity = c.connectivity;
  m.distance_error = c.distance_error;
  m.likelihood = c.likelihood;
  m.probability = c.probability;
  m.rule_base = static_cast<std::int8_t>(c.rules);
  m.decided = c.decided;
  static_assert(sizeof m.weights == sizeof c.weights);
  std::copy(c.weights.begin(), c.weights.end(), m.weights);
  return m;
}

MatchCandidate from_lcm(const maploop_lcm::map_candidate_t& m) {
  MatchCandidate c;
  c.link = {static_cast<std::uint32_t>(m.link), m.forward != 0};
  c.way_id = m.way_id;
  c.node_a = m.node_a;
  c.node_b = m.node_b;
  c.along = m.along;
  c.distance = m.distance;
  c.azimuth_error = m.azimuth_error;
  c.connectivity = m.connectivity;
  c.distance_error = m.distance_error;
  c.likelihood = m.likelihood;
  c.probability = m.probability;
  c.rules = enumerator_from(m.rule_base, RuleBase::junction, "map_candidate_t.rule_base");
  c.decided = m.decided != 0;
  std::copy(std::begin(m.weights), std::end(m.weights), c.weights.begin());
  return c;
}

void add_words(const MapMatchWords::Candidate& words, maploop_lcm::map_candidate_t& m) {
  m.road = words.road;
  m.rules = words.rules;
  m.rule_count = static_cast<std::int32_t>(m.rules.size());
  m.objections = words.objections;
  m.objection_count = static_cast<std::int32_t>(m.objections.size());
}

}  // namespace

maploop_lcm::map_match_t to_lcm(const MapMatch& match, const MapMatchWords& words) {
  maploop_lcm::map_match_t m{};
  m.header = header_of(match);
  m.phase = static_cast<std::int8_t>(match.phase);
  m.refusal = static_cast<std::int8_t>(match.refusal);
  m.on_road = match.on_road;
  m.explanation = words.explanation;
  m.p_link = match.probability;
  m.margin = match.margin;
  m.p_off_road = match.off_road;
  m.likelihood = match.likelihood;
  m.link = match.link.link;
  m.forward = match.link.forward;
  m.way_id = match.way_id;
  m.node_a = match.node_a;
  m.node_b = match.node_b;
  m.origin_latitude = match.origin.latitude;
  m.origin_longitude = match.origin.longitude;
  m.origin_height = match.origin.height;
  write<2>(match.vehicle_enu, m.vehicle_enu);
  write<2>(match.covariance, m.covariance);
  m.vehicle_azimuth = match.vehicle_azimuth;
  m.speed = match.speed;
  write<2>(match.matched_enu, m.matched_enu);
  m.sigma_along = match.sigma_along;
  m.sigma_across = match.sigma_across;
  m.link_azimuth = match.link_azimuth;
  m.cross_track = match.cross_track;
  m.half_width = match.half_width;
  m.bend = match.bend;
  m.along = match.along;
  m.to_junction = match.to_junction;
  m.candidate_count = static_cast<std::int32_t>(match.candidate_count);
  for (std::size_t i = 0; i < match.candidate_count; ++i) {
    m.candidates.push_back(to_lcm(match.candidates[i]));
    if (i < words.candidates.size()) add_words(words.candidates[i], m.candidates.back());
  }
  return m;
}

MapMatch from_lcm(const maploop_lcm::map_match_t& m) {
  MapMatch match;
  set_sample(match, m.header);
  match.phase = enumerator_from(m.phase, MatchPhase::off_road, "map_match_t.phase");
  match.refusal = enumerator_from(m.refusal, FixRefusal::no_position, "map_match_t.refusal");
  match.on_road = m.on_road != 0;
  match.probability = m.p_link;
  match.margin = m.margin;
  match.off_road = m.p_off_road;
  match.likelihood = m.likelihood;
  match.link = {static_cast<std::uint32_t>(m.link), m.forward != 0};
  match.way_id = m.way_id;
  match.node_a = m.node_a;
  match.node_b = m.node_b;
  match.origin = {m.origin_latitude, m.origin_longitude, m.origin_height};
  read<2>(m.vehicle_enu, match.vehicle_enu);
  read<2>(m.covariance, match.covariance);
  match.vehicle_azimuth = m.vehicle_azimuth;
  match.speed = m.speed;
  read<2>(m.matched_enu, match.matched_enu);
  match.sigma_along = m.sigma_along;
  match.sigma_across = m.sigma_across;
  match.link_azimuth = m.link_azimuth;
  match.cross_track = m.cross_track;
  match.half_width = m.half_width;
  match.bend = m.bend;
  match.along = m.along;
  match.to_junction = m.to_junction;
  if (m.candidates.size() > match.candidates.size())
    throw std::invalid_argument("map_match_t has " + std::to_string(m.candidates.size()) +
                                " candidates, more than this version holds");
  match.candidate_count = m.candidates.size();
  for (std::size_t i = 0; i < match.candidate_count; ++i)
    match.candidates[i] = from_lcm(m.candidates[i]);
  return match;
}

}  // namespace maploop
