#include "msgs/lcm/conversion_parts.h"
#include "msgs/lcm/conversions.h"

namespace maploop {

maploop_lcm::preview_t to_lcm(const Preview& preview) {
  maploop_lcm::preview_t m{};
  m.header = header_of(preview);
  m.width = preview.width;
  m.height = preview.height;
  m.jpeg = preview.jpeg;
  m.jpeg_size = static_cast<std::int32_t>(m.jpeg.size());
  m.track_count = static_cast<std::int32_t>(preview.tracks.size());
  for (const Preview::Track& t : preview.tracks) {
    m.track_from_u.push_back(t.from_u);
    m.track_from_v.push_back(t.from_v);
    m.track_u.push_back(t.u);
    m.track_v.push_back(t.v);
  }
  m.scan_stamp_ns = to_nanoseconds(preview.scan_stamp);
  m.point_count = static_cast<std::int32_t>(preview.points.size());
  for (const Preview::Point& p : preview.points) {
    m.point_x.push_back(p.x);
    m.point_y.push_back(p.y);
    m.point_z.push_back(p.z);
  }
  return m;
}

Preview from_lcm(const maploop_lcm::preview_t& m) {
  Preview preview;
  set_sample(preview, m.header);
  preview.width = m.width;
  preview.height = m.height;
  preview.jpeg = m.jpeg;
  for (std::size_t i = 0; i < m.track_u.size(); ++i) {
    preview.tracks.push_back({m.track_from_u[i], m.track_from_v[i], m.track_u[i], m.track_v[i]});
  }
  preview.scan_stamp = from_nanoseconds(m.scan_stamp_ns);
  for (std::size_t i = 0; i < m.point_x.size(); ++i) {
    preview.points.push_back({m.point_x[i], m.point_y[i], m.point_z[i]});
  }
  return preview;
}

}  // namespace maploop
