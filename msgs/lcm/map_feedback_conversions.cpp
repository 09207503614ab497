#include <stdexcept>
#include <string>

#include "msgs/lcm/conversion_parts.h"
#include "msgs/lcm/conversions.h"

namespace maploop {

maploop_lcm::map_feedback_t to_lcm(const MapFeedback& f) {
  maploop_lcm::map_feedback_t m{};
  m.header = header_of(f);
  m.reason = static_cast<std::int8_t>(f.reason);
  m.explanation = std::string(to_string(f.reason));
  m.position = f.position;
  m.azimuth = f.azimuth;
  m.reset = f.reset;
  m.new_road = f.new_road;
  m.latitude = f.point.latitude;
  m.longitude = f.point.longitude;
  m.height = f.point.height;
  m.link_azimuth = f.link_azimuth;
  m.cross_track = f.cross_track;
  m.cross_sigma = f.cross_sigma;
  m.lane_sigma = f.lane_sigma;
  m.azimuth_sigma = f.azimuth_sigma;
  m.probability = f.probability;
  return m;
}

MapFeedback from_lcm(const maploop_lcm::map_feedback_t& m) {
  MapFeedback f;
  set_sample(f, m.header);
  f.reason = enumerator_from(m.reason, FeedbackReason::not_yet, "map_feedback_t.reason");
  f.position = m.position != 0;
  f.azimuth = m.azimuth != 0;
  f.reset = m.reset != 0;
  f.new_road = m.new_road != 0;
  f.point = {m.latitude, m.longitude, m.height};
  f.link_azimuth = m.link_azimuth;
  f.cross_track = m.cross_track;
  f.cross_sigma = m.cross_sigma;
  f.lane_sigma = m.lane_sigma;
  f.azimuth_sigma = m.azimuth_sigma;
  f.probability = m.probability;
  return f;
}

}  // namespace maploop
