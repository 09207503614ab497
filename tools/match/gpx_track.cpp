#include <cmath>
#include <stdexcept>
#include <string>

#include "msgs/frames.h"
#include "tools/evaluate/text_lines.h"
#include "tools/match/track_file.h"

namespace maploop::match {
namespace {

// Returns the text of a child element such as <time>...</time>, with or without a namespace prefix.
std::string_view child(std::string_view element, std::string_view name) {
  for (std::size_t at = element.find(name); at != std::string_view::npos;
       at = element.find(name, at + 1)) {
    const bool opens = at > 0 && (element[at - 1] == '<' || element[at - 1] == ':');
    const std::size_t close = at + name.size();
    if (!opens || close >= element.size() || element[close] != '>') continue;
    const auto end = element.find('<', close);
    return end == std::string_view::npos ? std::string_view()
                                         : element.substr(close + 1, end - close - 1);
  }
  return {};
}

std::string_view attribute(std::string_view tag, std::string_view name) {
  const auto at = tag.find(std::string(" ") + std::string(name) + "=");
  if (at == std::string_view::npos) return {};
  const std::size_t quote = at + name.size() + 2;
  if (quote >= tag.size()) return {};
  const auto end = tag.find(tag[quote], quote + 1);
  return end == std::string_view::npos ? std::string_view()
                                       : tag.substr(quote + 1, end - quote - 1);
}

double number(std::string_view text) {
  return evaluation::number_of<double>(text).value_or(mapmatch::unknown);
}

}  // namespace

Track parse_gpx_track(std::string_view text, std::string_view name, const TrackOptions& options) {
  Track track;
  std::size_t at = 0;
  while ((at = text.find("<trkpt", at)) != std::string_view::npos) {
    const auto fail = [&](const std::string& what) {
      return std::runtime_error(std::string(name) + ": track point " +
                                std::to_string(track.size() + 1) + ": " + what);
    };
    const auto tag_end = text.find('>', at);
    if (tag_end == std::string_view::npos) throw fail("it does not end");
    const bool alone = text[tag_end - 1] == '/';
    const auto end = alone ? tag_end : text.find("</trkpt>", tag_end);
    if (end == std::string_view::npos) throw fail("it does not end");
    const std::string_view tag = text.substr(at, tag_end - at);
    const std::string_view inside = text.substr(tag_end, end - tag_end);
    mapmatch::VehicleFix fix;
    const double latitude = number(attribute(tag, "lat")),
                 longitude = number(attribute(tag, "lon"));
    if (std::isnan(latitude) || std::isnan(longitude)) throw fail("no lat and lon");
    fix.position = {radians(latitude), radians(longitude), 0.0};
    const auto time = child(inside, "time");
    if (time.empty()) throw fail("no time, which matching needs");
    const auto stamp = parse_track_time(time);
    if (!stamp) throw fail("the time '" + std::string(time) + "' cannot be read");
    fix.stamp = *stamp;
    fix.covariance = options.sigma * options.sigma * Eigen::Matrix2d::Identity();
    fix.speed = number(child(inside, "speed"));
    fix.azimuth = radians(number(child(inside, "course")));
    fix.hdop = number(child(inside, "hdop"));
    keep(fix, name, track);
    at = end;
  }
  return track;
}

}  // namespace maploop::match
