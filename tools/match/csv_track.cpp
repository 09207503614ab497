#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "msgs/frames.h"
#include "tools/evaluate/text_lines.h"
#include "tools/match/track_file.h"

namespace maploop::match {
namespace {

using mapmatch::VehicleFix;

// A value that a fix has as it is written, but for its unit.
struct Value {
  std::string_view names;
  double VehicleFix::*member;
  double unit = 1.0;
};
constexpr std::array values{
    Value{"speed|v|vf|speed_mps|forward_speed", &VehicleFix::speed},
    Value{"sigma_speed|speed_sigma", &VehicleFix::speed_sigma},
    Value{"azimuth_deg|azimuth|heading|course|heading_deg|course_deg", &VehicleFix::azimuth,
          radians(1.0)},
    Value{"azimuth_sigma_deg|sigma_azimuth", &VehicleFix::azimuth_sigma, radians(1.0)},
    Value{"yaw_rate|wz", &VehicleFix::yaw_rate},
    Value{"hdop", &VehicleFix::hdop},
    Value{"visual_speed", &VehicleFix::visual_speed},
    Value{"visual_azimuth_deg", &VehicleFix::visual_azimuth, radians(1.0)}};

constexpr const char* incomplete = "no columns t, lat and lon in the header line";

class CsvTrackReader {
 public:
  CsvTrackReader(std::string_view text, std::string_view name, const TrackOptions& options)
      : rows_(text, std::string(name)), options_(options) {
    for (std::size_t i = 0; i < values.size(); ++i) columns_[i] = rows_.column(values[i].names);
  }

  bool next() { return rows_.next(); }

  VehicleFix fix() const {
    VehicleFix fix;
    const auto stamp = parse_track_time(rows_.cell(time_));
    if (!stamp) rows_.fail("'" + std::string(rows_.cell(time_)) + "' is not a time");
    fix.stamp = *stamp;
    fix.position = {radians(number(latitude_)), radians(number(longitude_)), 0.0};
    set_accuracy(fix);
    if (const double yaw = number(yaw_); std::isfinite(yaw)) fix.azimuth = azimuth_from_yaw(yaw);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double given = number(columns_[i]);
      if (std::isfinite(given)) fix.*values[i].member = given * values[i].unit;
    }
    return fix;
  }

 private:
  double number(std::size_t column) const {
    return rows_.cell(column).empty() ? mapmatch::unknown : rows_.number<double>(column);
  }

  void set_accuracy(VehicleFix& fix) const {
    const double each = number(sigma_), both = std::isfinite(each) ? each : options_.sigma;
    const auto variance = [&](double own) {
      const double known = std::max(options_.min_sigma, std::isfinite(own) ? own : both);
      return known * known;
    };
    fix.covariance =
        Eigen::Vector2d(variance(number(sigma_east_)), variance(number(sigma_north_))).asDiagonal();
    const double ee = number(cov_ee_), nn = number(cov_nn_), en = number(cov_en_);
    if (!std::isfinite(ee) || !std::isfinite(nn)) return;
    const double off_diagonal = std::isfinite(en) ? en : 0.0;
    fix.covariance << ee, off_diagonal, off_diagonal, nn;
  }

  evaluation::NamedColumns rows_;
  const TrackOptions& options_;
  const std::size_t time_ = rows_.column("t|time|timestamp|stamp|gps_tow|gps time", incomplete);
  const std::size_t latitude_ = rows_.column("lat|latitude|lat_deg", incomplete);
  const std::size_t longitude_ = rows_.column("lon|lng|longitude|lon_deg", incomplete);
  const std::size_t sigma_ = rows_.column("sigma|accuracy|pos_accuracy|sigma_m");
  const std::size_t sigma_east_ = rows_.column("sigma_e|sigma_east");
  const std::size_t sigma_north_ = rows_.column("sigma_n|sigma_north");
  const std::size_t cov_ee_ = rows_.column("cov_ee"), cov_en_ = rows_.column("cov_en");
  const std::size_t cov_nn_ = rows_.column("cov_nn"), yaw_ = rows_.column("yaw");
  std::array<std::size_t, values.size()> columns_{};
};

}  // namespace

Track parse_csv_track(std::string_view text, std::string_view name, const TrackOptions& options) {
  CsvTrackReader reader(text, name, options);
  Track track;
  while (reader.next()) keep(reader.fix(), name, track);
  return track;
}

}  // namespace maploop::match
