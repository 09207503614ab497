#include "ppp/readers/streams/ubx_pvt.h"

#include <chrono>
#include <cmath>
#include <optional>

#include "msgs/frames.h"

namespace maploop::ppp {
namespace {

constexpr std::size_t size = 92;

template <class T>
double scaled(std::string_view payload, std::size_t at, double unit) {
  return unit * static_cast<double>(ubx_number<T>(payload, at));
}

// The time of the week has no leap seconds. The date gives the week, and the nanoseconds refine the
// milliseconds.
std::optional<GpsTime> time_of(std::string_view p) {
  using namespace std::chrono;
  constexpr Duration week = hours(24 * 7);
  const year_month_day date(year(ubx_number<std::uint16_t>(p, 4)),
                            month(ubx_number<std::uint8_t>(p, 6)),
                            day(ubx_number<std::uint8_t>(p, 7)));
  const Duration since = milliseconds(ubx_number<std::uint32_t>(p, 0));
  if (!date.ok() || date < year_month_day(year(1990) / 1 / 1) ||
      date > year_month_day(year(2200) / 1 / 1) || since >= week)
    return {};
  const Time utc = sys_days(date) + hours(ubx_number<std::uint8_t>(p, 8));
  const GpsTime rounded = nearest_moment(from_utc(utc), since, week);
  const Duration nanoseconds(ubx_number<std::int32_t>(p, 16));
  return nearest_moment(rounded, nanoseconds, seconds(1));
}

}  // namespace

bool decode_pvt(const UbxFrame& frame, UbxPvt& pvt, std::string& problem) {
  constexpr unsigned date_and_time = 3, fix_ok = 1;
  constexpr int in_space = 3, with_dead_reckoning = 4;
  if (frame.message_class != 0x01 || frame.id != 0x07) return false;
  const std::string_view p = frame.payload;
  if (p.size() != size) {
    problem = "NAV-PVT has " + std::to_string(p.size()) + " bytes, not 92";
    return false;
  }
  if ((ubx_number<std::uint8_t>(p, 11) & date_and_time) != date_and_time) return false;
  const auto time = time_of(p);
  if (!time) {
    problem = "NAV-PVT has an invalid date or time of week";
    return false;
  }
  pvt = {};
  pvt.time = *time;
  const int kind = ubx_number<std::uint8_t>(p, 20);
  if ((kind != in_space && kind != with_dead_reckoning) ||
      (ubx_number<std::uint8_t>(p, 21) & fix_ok) == 0)
    return true;
  pvt.satellites = ubx_number<std::uint8_t>(p, 23);
  pvt.position = {radians(scaled<std::int32_t>(p, 28, 1e-7)),
                  radians(scaled<std::int32_t>(p, 24, 1e-7)), scaled<std::int32_t>(p, 32, 1e-3)};
  pvt.horizontal_sigma = scaled<std::uint32_t>(p, 40, 1e-3);
  pvt.vertical_sigma = scaled<std::uint32_t>(p, 44, 1e-3);
  pvt.velocity_enu = {scaled<std::int32_t>(p, 52, 1e-3), scaled<std::int32_t>(p, 48, 1e-3),
                      -scaled<std::int32_t>(p, 56, 1e-3)};
  pvt.speed_sigma = scaled<std::uint32_t>(p, 68, 1e-3);
  pvt.fix = std::abs(pvt.position.latitude) <= radians(90.0) &&
            std::abs(pvt.position.longitude) <= radians(180.0) && pvt.horizontal_sigma > 0.0 &&
            pvt.vertical_sigma > 0.0 && pvt.speed_sigma > 0.0;
  if (!pvt.fix) problem = "NAV-PVT has an invalid position or accuracy";
  return pvt.fix;
}

}  // namespace maploop::ppp
