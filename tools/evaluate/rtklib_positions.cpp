// Reads the positions that RTKLIB writes.
#include <cmath>
#include <stdexcept>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "tools/evaluate/text_file.h"
#include "tools/evaluate/trajectory_file.h"

namespace maploop::evaluation {
namespace {

// A line is "2021/09/22 06:30:00.000  x y z Q ns ...".
Time stamp_of(const TextLines& lines, const Cells& words) {
  std::string stamp = std::string(words[0]) + ' ' + std::string(words[1]);
  for (char& c : stamp) {
    if (c == '/') c = '-';
  }
  try {
    return parse_time(stamp);
  } catch (const std::invalid_argument&) {
    lines.fail("'" + stamp +
               "' is no date and time; of RTKLIB's forms of time, only "
               "yyyy/mm/dd hh:mm:ss can be read (its setting out-timeform=hms)");
  }
}

Geodetic place_of(const TextLines& lines, const Cells& words) {
  constexpr double lowest = 6.3e6;  // m, from the earth's centre
  Eigen::Vector3d p;
  for (int i = 0; i < 3; ++i) {
    const auto number = number_of<double>(words[static_cast<std::size_t>(i) + 2]);
    if (!number || !std::isfinite(*number)) lines.fail("a coordinate is not a finite number");
    p[i] = *number;
  }
  if (p.norm() > lowest) return ppp::geodetic_from_ecef(p);
  return {radians(p.x()), radians(p.y()), p.z()};
}

}  // namespace

StampedTrajectory read_rtklib_positions(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  TextLines lines(text, file.string());
  StampedTrajectory trajectory;
  trajectory.has_attitude = false;
  while (lines.next()) {
    if (lines.line().starts_with('%')) continue;
    const Cells words = lines.words();
    if (words.size() < 5) lines.fail("a position has a date, a time and three coordinates");
    const Time stamp = stamp_of(lines, words);
    if (!trajectory.stamps.empty() && stamp <= trajectory.stamps.back())
      lines.fail("its stamp is not after the line's before");
    const Geodetic place = place_of(lines, words);
    if (!trajectory.origin) trajectory.origin = place;
    trajectory.stamps.push_back(stamp);
    trajectory.poses.emplace_back(
        Eigen::Translation3d(LocalFrame(*trajectory.origin).to_enu(place)));
  }
  if (trajectory.poses.empty()) throw std::runtime_error(file.string() + " holds no position");
  return trajectory;
}

}  // namespace maploop::evaluation
