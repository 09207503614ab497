#include "ppp/products/ionosphere_maps.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::ppp {
namespace {

using Axis = IonosphereMapFile::Axis;

// The IGS states an accuracy of 2 to 8 TECU for its maps ("GNSS atmospheric products").
constexpr double usual_sigma = 5.0, least_sigma = 1.0;  // TECU

// A place between two nodes of an axis.
struct Between {
  int lower = 0;
  double share = 0.0;  // of the upper node
};

std::optional<Between> between(const Axis& axis, double value) {
  const double x = (value - axis.first) / axis.step;
  if (!(x >= 0.0 && x <= axis.count - 1)) return {};
  const int lower = std::min(static_cast<int>(x), axis.count - 2);
  return Between{lower, x - lower};
}

// Longitudes repeat after a turn. A map without the meridian at its end again has a gap there.
std::optional<Between> between_longitudes(const Axis& axis, double degrees) {
  const double low = std::min(axis.first, axis.first + axis.step * (axis.count - 1));
  return between(axis, degrees - 360.0 * std::floor((degrees - low) / 360.0));
}

// Returns the value between four nodes; NaN beside a node that has none.
double interpolated(const std::vector<float>& values, const Axis& longitude, Between row,
                    Between column) {
  const auto node = [&](int i, int j) {
    const double share =
        (i == 0 ? 1.0 - row.share : row.share) * (j == 0 ? 1.0 - column.share : column.share);
    const int at = (row.lower + i) * longitude.count + column.lower + j;
    return share == 0.0 ? 0.0 : share * static_cast<double>(values[static_cast<std::size_t>(at)]);
  };
  return node(0, 0) + node(0, 1) + node(1, 0) + node(1, 1);
}

// Returns what a map says `since` hours after its moment, if the ionosphere only turned with the
// sun since then.
std::optional<VerticalElectrons> of_map(const IonosphereMapFile& file, const IonosphereMap& map,
                                        const PiercePoint& place, double since) {
  const auto row = between(file.latitude, degrees(place.latitude));
  const auto column = between_longitudes(file.longitude, degrees(place.longitude) + 15.0 * since);
  if (!row || !column) return {};
  const double value = interpolated(map.electrons, file.longitude, *row, *column);
  if (std::isnan(value)) return {};
  const double sigma =
      map.sigma.empty() ? usual_sigma : interpolated(map.sigma, file.longitude, *row, *column);
  return VerticalElectrons{value, std::isnan(sigma) ? usual_sigma : std::max(sigma, least_sigma)};
}

bool contains(const IonosphereMapFile& file, GpsTime t) {
  return file.maps.front().time <= t && t <= file.maps.back().time;
}

std::optional<VerticalElectrons> of_file(const IonosphereMapFile& file, const PiercePoint& place,
                                         GpsTime t) {
  constexpr double longest = 6.0;  // h
  if (!contains(file, t)) return {};
  const auto& maps = file.maps;
  auto next = std::ranges::lower_bound(maps, t, {}, &IonosphereMap::time);
  if (next == maps.begin()) return of_map(file, *next, place, 0.0);
  const auto last = std::prev(next);
  const double since = to_seconds(t - last->time) / 3600.0;
  const double length = to_seconds(next->time - last->time) / 3600.0;
  if (length > longest) return {};
  const auto before = of_map(file, *last, place, since);
  const auto after = of_map(file, *next, place, since - length);
  if (!before || !after) return {};
  const double share = since / length;
  return VerticalElectrons{std::lerp(before->value, after->value, share),
                           std::lerp(before->sigma, after->sigma, share)};
}

}  // namespace

bool IonosphereMaps::covers(GpsTime t) const {
  return std::ranges::any_of(*files_, [t](const auto& file) { return contains(file, t); });
}

std::optional<VerticalElectrons> IonosphereMaps::at(const PiercePoint& place, GpsTime t) const {
  for (std::size_t i = 0; i < files_->size(); ++i) {
    if (auto electrons = of_file((*files_)[i], place, t)) {
      electrons->source = i + 1;
      return electrons;
    }
  }
  return {};
}

}  // namespace maploop::ppp
