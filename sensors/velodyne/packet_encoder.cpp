#include "sensors/velodyne/packet_encoder.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "msgs/frames.h"

namespace maploop::sensors {
namespace {

constexpr std::size_t unit_lasers = 64;
constexpr std::size_t firings_a_packet = velodyne_blocks / 2;  // upper and lower block
constexpr Duration firing_period = std::chrono::microseconds(48);
constexpr double range_unit = 2e-3;  // m

void put(std::span<std::uint8_t> bytes, std::size_t at, std::uint64_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}

double distance_of(const LidarPoint& p) {
  return std::hypot(static_cast<double>(p.x), static_cast<double>(p.y));
}

// Returns the azimuth clockwise from the rear, as a share of a turn.
double phase_of(const LidarPoint& p) {
  const double clockwise =
      -std::atan2(static_cast<double>(p.y), static_cast<double>(p.x)) / (2.0 * M_PI);
  return std::fmod(clockwise + 1.5, 1.0);
}

// Fits height = distance tan(elevation) + offset / cos(elevation) by least squares.
std::optional<LaserPlace> fit_cone(std::span<const LidarPoint> points) {
  constexpr std::size_t fewest = 100;
  if (points.size() < fewest) return {};
  double n = 0.0, d = 0.0, z = 0.0, dd = 0.0, dz = 0.0;
  for (const LidarPoint& p : points) {
    const double distance = distance_of(p), height = static_cast<double>(p.z);
    n += 1.0;
    d += distance;
    z += height;
    dd += distance * distance;
    dz += distance * height;
  }
  const double spread = n * dd - d * d;
  constexpr double narrowest = 0.1;  // m, standard deviation of their distances
  if (spread < narrowest * narrowest * n * n) return {};
  const double slope = (n * dz - d * z) / spread;
  const double elevation = std::atan(slope);
  return LaserPlace{elevation, (z - slope * d) / n * std::cos(elevation)};
}

}  // namespace

std::optional<Hdl64Lasers> fit_lasers(std::span<const LidarPoint> points) {
  // A laser ends where azimuths restart at the front.
  const auto quarter = [](const LidarPoint& p) {
    return p.y >= 0.0F ? (p.x >= 0.0F ? 0 : 1) : (p.x < 0.0F ? 2 : 3);
  };
  Hdl64Lasers lasers;
  std::size_t laser = 0, begin = 0;
  for (std::size_t i = 1; i <= points.size(); ++i) {
    const bool ends =
        i == points.size() || (quarter(points[i - 1]) == 3 && quarter(points[i]) == 0);
    if (!ends) continue;
    const auto cone = fit_cone(points.subspan(begin, i - begin));
    if (!cone || laser == unit_lasers) return {};
    lasers[laser++] = *cone;
    begin = i;
  }
  if (laser != unit_lasers) return {};
  const bool descending =
      std::is_sorted(lasers.begin(), lasers.end(),
                     [](const auto& a, const auto& b) { return a.elevation > b.elevation; });
  return descending ? std::optional(lasers) : std::nullopt;
}

void write_velodyne_calibration(const std::filesystem::path& file, const Hdl64Lasers& lasers) {
  std::ofstream out(file);
  out.precision(9);
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n"
         "<boost_serialization signature=\"serialization::archive\" version=\"4\">\n"
         "<DB>\n<distLSB_>0.2</distLSB_>\n<points_>\n<count>64</count>\n";
  for (std::size_t i = 0; i < lasers.size(); ++i) {
    out << "<item><px><id_>" << i << "</id_><rotCorrection_>0</rotCorrection_><vertCorrection_>"
        << degrees(lasers[i].elevation)
        << "</vertCorrection_><distCorrection_>0</distCorrection_><vertOffsetCorrection_>"
        << 100.0 * lasers[i].vertical_offset
        << "</vertOffsetCorrection_><horizOffsetCorrection_>0</horizOffsetCorrection_></px>"
           "</item>\n";
  }
  out << "</points_></DB></boost_serialization>\n";
  out.close();
  if (!out) {
    throw std::runtime_error("cannot write '" + file.string() +
                             "': check that its folder exists and may be written");
  }
}

void TimedPacket::set_time(Time t) {
  const auto us =
      std::chrono::floor<std::chrono::microseconds>(t - std::chrono::floor<std::chrono::hours>(t));
  put(bytes, 1200, static_cast<std::uint64_t>(us.count()), 4);
}

// The cones do not cross at any distance at which a road vehicle sees something.
std::size_t Hdl64Encoder::laser_of(const LidarPoint& p, double distance) const {
  const auto height = [distance](const LaserPlace& l) {
    return (distance * std::sin(l.elevation) + l.vertical_offset) / std::cos(l.elevation);
  };
  const double z = static_cast<double>(p.z);
  const auto below = std::partition_point(lasers_.begin(), lasers_.end(),
                                          [&](const LaserPlace& l) { return height(l) > z; });
  if (below == lasers_.begin()) return 0;
  const auto above = below - 1;
  const bool nearer_above = below == lasers_.end() || height(*above) - z < z - height(*below);
  return static_cast<std::size_t>((nearer_above ? above : below) - lasers_.begin());
}

void Hdl64Encoder::encode(const LidarScan& scan, EncodedTurn& turn) {
  const Duration lasts = scan.end - scan.start;
  const auto packets = static_cast<std::size_t>(
      std::max<std::int64_t>(1, lasts / (static_cast<int>(firings_a_packet) * firing_period)));
  const std::size_t firings = packets * firings_a_packet;
  returns_.assign(firings * unit_lasers, {});
  turn.points = turn.crowded = 0;
  for (const LidarPoint& p : scan.points) {
    const double distance = distance_of(p);
    const std::size_t laser = laser_of(p, distance);
    const LaserPlace& l = lasers_[laser];
    const double range =
        (distance + l.vertical_offset * std::sin(l.elevation)) / std::cos(l.elevation);
    const long units = std::lround(range / range_unit);
    const auto firing =
        static_cast<std::size_t>(std::lround(phase_of(p) * static_cast<double>(firings))) % firings;
    VelodyneReturn& r = returns_[firing * unit_lasers + laser];
    if (units <= 0 || units > 0xffff || r.range != 0) {
      ++turn.crowded;
      continue;
    }
    r.range = static_cast<std::uint16_t>(units);
    r.intensity = static_cast<std::uint8_t>(
        std::lround(255.0 * std::clamp(static_cast<double>(p.reflectance), 0.0, 1.0)));
    ++turn.points;
  }
  turn.packets.resize(packets);
  for (std::size_t i = 0; i < packets; ++i) {
    TimedPacket& packet = turn.packets[i];
    packet.first_firing =
        scan.start + static_cast<std::int64_t>(i) * lasts / static_cast<std::int64_t>(packets);
    for (std::size_t block = 0; block < velodyne_blocks; ++block) {
      const std::size_t firing = i * firings_a_packet + block / 2;
      const auto azimuth = static_cast<std::uint64_t>(std::lround(
          velodyne_full_turn * (0.5 + static_cast<double>(firing) / static_cast<double>(firings))));
      put(packet.bytes, 100 * block, block % 2 == 0 ? 0xeeff : 0xddff, 2);
      put(packet.bytes, 100 * block + 2, azimuth % velodyne_full_turn, 2);
      for (std::size_t k = 0; k < velodyne_block_returns; ++k) {
        const VelodyneReturn& r =
            returns_[firing * unit_lasers + block % 2 * velodyne_block_returns + k];
        put(packet.bytes, 100 * block + 4 + 3 * k, r.range, 2);
        packet.bytes[100 * block + 6 + 3 * k] = r.intensity;
      }
    }
    packet.set_time(packet.first_firing);
  }
}

}  // namespace maploop::sensors
