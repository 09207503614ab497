#include "tools/match/csv_track.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "msgs/frames.h"
#include "tools/match/cells.h"
#include "tools/match/track_time.h"

namespace maploop::match {
namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\"";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

char separator_of(std::string_view header) {
  for (const char c : {',', ';', '\t'})
    if (header.find(c) != std::string_view::npos) return c;
  return ',';
}

enum class Column {
  time,
  latitude,
  longitude,
  sigma,
  sigma_east,
  sigma_north,
  cov_ee,
  cov_en,
  cov_nn,
  speed,
  speed_sigma,
  azimuth,
  azimuth_sigma,
  yaw,
  yaw_rate,
  hdop,
  visual_speed,
  visual_azimuth
};

const std::map<std::string_view, Column>& column_names() {
  using enum Column;
  static const std::map<std::string_view, Column> names{{"t", time},
                                                        {"time", time},
                                                        {"timestamp", time},
                                                        {"stamp", time},
                                                        {"gps_tow", time},
                                                        {"gps time", time},
                                                        {"lat", latitude},
                                                        {"latitude", latitude},
                                                        {"lat_deg", latitude},
                                                        {"lon", longitude},
                                                        {"lng", longitude},
                                                        {"longitude", longitude},
                                                        {"lon_deg", longitude},
                                                        {"sigma", sigma},
                                                        {"accuracy", sigma},
                                                        {"pos_accuracy", sigma},
                                                        {"sigma_m", sigma},
                                                        {"sigma_e", sigma_east},
                                                        {"sigma_n", sigma_north},
                                                        {"sigma_east", sigma_east},
                                                        {"sigma_north", sigma_north},
                                                        {"cov_ee", cov_ee},
                                                        {"cov_en", cov_en},
                                                        {"cov_nn", cov_nn},
                                                        {"speed", speed},
                                                        {"v", speed},
                                                        {"vf", speed},
                                                        {"speed_mps", speed},
                                                        {"forward_speed", speed},
                                                        {"sigma_speed", speed_sigma},
                                                        {"speed_sigma", speed_sigma},
                                                        {"azimuth_deg", azimuth},
                                                        {"azimuth", azimuth},
                                                        {"heading", azimuth},
                                                        {"course", azimuth},
                                                        {"heading_deg", azimuth},
                                                        {"course_deg", azimuth},
                                                        {"azimuth_sigma_deg", azimuth_sigma},
                                                        {"sigma_azimuth", azimuth_sigma},
                                                        {"yaw", yaw},
                                                        {"yaw_rate", yaw_rate},
                                                        {"wz", yaw_rate},
                                                        {"hdop", hdop},
                                                        {"visual_speed", visual_speed},
                                                        {"visual_azimuth_deg", visual_azimuth}};
  return names;
}

class Reader {
 public:
  Reader(std::string_view name, const TrackOptions& options) : name_(name), options_(options) {}

  Track read(std::string_view text) {
    Track track;
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    while (!text.empty()) {
      const auto end = text.find('\n');
      const std::string_view line = trimmed(text.substr(0, end));
      text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
      ++line_;
      if (line.empty() || line.front() == '#') continue;
      if (columns_.empty()) {
        take_header(line);
      } else {
        keep(fix(cells_of(line)), name_, track);
      }
    }
    if (columns_.empty()) fail("the file is empty");
    return track;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(std::string(name_) + ":" + std::to_string(line_) + ": " + what);
  }

  Cells cells_of(std::string_view line) const {
    Cells cells = split(line, separator_);
    if (cells.size() > input_limits::columns)
      fail("more than " + std::to_string(input_limits::columns) + " columns");
    std::transform(cells.begin(), cells.end(), cells.begin(), trimmed);
    return cells;
  }

  void take_header(std::string_view line) {
    separator_ = separator_of(line);
    const Cells cells = cells_of(line);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::string name(cells[i]);
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      const auto found = column_names().find(name);
      if (found != column_names().end()) columns_.emplace(found->second, i);
    }
    if (!columns_.contains(Column::latitude) || !columns_.contains(Column::longitude) ||
        !columns_.contains(Column::time))
      fail("no columns t, lat and lon in the header line");
  }

  std::string_view cell(const Cells& cells, Column column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end()) return {};
    if (found->second >= cells.size()) fail("a column is missing");
    return cells[found->second];
  }

  double number(const Cells& cells, Column column) const {
    const std::string_view text = cell(cells, column);
    if (text.empty()) return mapmatch::unknown;
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      fail("'" + std::string(text) + "' is not a number");
    return value;
  }

  mapmatch::VehicleFix fix(const Cells& cells) const {
    mapmatch::VehicleFix fix;
    const auto stamp = parse_track_time(cell(cells, Column::time));
    if (!stamp) fail("'" + std::string(cell(cells, Column::time)) + "' is not a time");
    fix.stamp = *stamp;
    fix.position = {radians(number(cells, Column::latitude)),
                    radians(number(cells, Column::longitude)), 0.0};
    set_accuracy(fix, cells);
    const auto set = [&](double& value, Column column, double unit = 1.0) {
      const double given = number(cells, column);
      if (std::isfinite(given)) value = given * unit;
    };
    set(fix.speed, Column::speed);
    set(fix.speed_sigma, Column::speed_sigma);
    if (const double yaw = number(cells, Column::yaw); std::isfinite(yaw))
      fix.azimuth = azimuth_from_yaw(yaw);
    set(fix.azimuth, Column::azimuth, radians(1.0));
    set(fix.azimuth_sigma, Column::azimuth_sigma, radians(1.0));
    set(fix.yaw_rate, Column::yaw_rate);
    set(fix.hdop, Column::hdop);
    set(fix.visual_speed, Column::visual_speed);
    set(fix.visual_azimuth, Column::visual_azimuth, radians(1.0));
    return fix;
  }

  void set_accuracy(mapmatch::VehicleFix& fix, const Cells& cells) const {
    const double each = number(cells, Column::sigma);
    const double both = std::isfinite(each) ? each : options_.sigma;
    const double east = number(cells, Column::sigma_east);
    const double north = number(cells, Column::sigma_north);
    const auto variance = [&](double sigma) {
      const double known = std::max(options_.min_sigma, std::isfinite(sigma) ? sigma : both);
      return known * known;
    };
    fix.covariance = Eigen::Vector2d(variance(east), variance(north)).asDiagonal();
    const double ee = number(cells, Column::cov_ee), nn = number(cells, Column::cov_nn);
    if (std::isfinite(ee) && std::isfinite(nn)) {
      const double en = number(cells, Column::cov_en);
      const double off_diagonal = std::isfinite(en) ? en : 0.0;
      fix.covariance << ee, off_diagonal, off_diagonal, nn;
    }
  }

  std::string_view name_;
  const TrackOptions& options_;
  int line_ = 0;
  char separator_ = ',';
  std::map<Column, std::size_t> columns_;
};

}  // namespace

Track parse_csv_track(std::string_view text, std::string_view name, const TrackOptions& options) {
  return Reader(name, options).read(text);
}

}  // namespace maploop::match
