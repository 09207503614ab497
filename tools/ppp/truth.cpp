#include "tools/ppp/truth.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <vector>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "ppp/readers/files/lines.h"
#include "sensors/folder/number_table.h"
#include "tools/evaluate/rtklib_positions.h"

namespace maploop::gnss {

using namespace maploop::ppp;

namespace {

std::vector<double> numbers(const Lines& lines, std::string text) {
  for (char& c : text) {
    if (c == ',') c = ' ';
  }
  std::istringstream stream(text);
  std::vector<double> values;
  for (std::string word; stream >> word;) {
    const auto value = parse_number(word);
    if (!value) lines.fail("'" + word + "' is no number");
    values.push_back(*value);
  }
  return values;
}

// X,Y,Z, or latitude, longitude (degrees) and height as RTKLIB writes them.
Eigen::Vector3d place_of(const Eigen::Vector3d& p, const std::string& text) {
  constexpr double lowest = 6.3e6, highest = 6.5e6;  // m, from the earth's centre
  if (p.norm() > lowest && p.norm() < highest) return p;
  const bool degrees_and_height =
      std::abs(p.x()) <= 90.0 && std::abs(p.y()) <= 360.0 && std::abs(p.z()) < 1e5;
  if (degrees_and_height) return ecef_from_geodetic({radians(p.x()), radians(p.y()), p.z()});
  throw ReadError("--truth: '" + text +
                  "' is no place near the earth's surface: give X,Y,Z in metres from the earth's "
                  "centre, or latitude,longitude,height in degrees and metres");
}

}  // namespace

Truth::Truth(const std::string& text, GpsTime near) {
  std::istringstream triple(text);
  Eigen::Vector3d p;
  char comma = 0, other = 0;
  if (triple >> p.x() >> comma >> p.y() >> other >> p.z() && comma == ',' && other == ',') {
    fixed_ = place_of(p, text);
    return;
  }
  if (!std::filesystem::exists(text)) {
    throw ReadError("--truth: '" + text +
                    "' is neither X,Y,Z in metres, nor latitude,longitude,height, nor a file");
  }
  if (sensors::is_pos_file(text)) {
    read_positions(text);
  } else {
    read_rows(text, near);
  }
}

// Fixed positions are more exact than others.
void Truth::read_positions(const std::string& file) {
  const std::vector<evaluation::RtklibPosition> all = evaluation::read_rtklib_positions(file);
  const auto fixed = [](const evaluation::RtklibPosition& p) { return p.quality == 1; };
  const bool some_fixed = std::any_of(all.begin(), all.end(), fixed);
  if (!some_fixed) {
    std::cerr << "maploop: '" << file << "' has no fixed position (quality 1); all of its "
              << all.size() << " positions are taken for the truth\n";
  }
  for (const evaluation::RtklibPosition& p : all) {
    if (!some_fixed || fixed(p)) points_[p.time] = p.place;
  }
}

void Truth::read_rows(const std::string& file, GpsTime near) {
  const std::string content = read_file(file);
  Lines lines(content, file);
  while (lines.next()) {
    const auto line = lines.line();
    if (line.empty() || line.find_first_of("0123456789") != 0) continue;
    if (line.size() > 10 && line[4] == '/')
      lines.fail("this is a row of RTKLIB's positions; give the file a name that ends in .pos");
    const auto values = numbers(lines, std::string(line));
    if (values.size() < 5) lines.fail("a row has an index, GPS seconds and XYZ");
    points_[gps_week_time(gps_week(near), values[1])] = {values[2], values[3], values[4]};
  }
  if (points_.empty()) throw ReadError(file + ": no rows of truth");
}

std::optional<Eigen::Vector3d> Truth::at(GpsTime t) const {
  if (fixed_) return fixed_;
  const auto after = points_.lower_bound(t);
  constexpr double same = 0.010;  // s
  if (after != points_.end() && to_seconds(after->first - t) < same) return after->second;
  if (after == points_.begin()) return {};
  const auto before = std::prev(after);
  if (to_seconds(t - before->first) < same) return before->second;
  if (after == points_.end()) return {};
  const double gap = to_seconds(after->first - before->first);
  if (gap > 1.1) return {};
  return before->second + (after->second - before->second) * (to_seconds(t - before->first) / gap);
}

}  // namespace maploop::gnss
