#include "tools/simulate/town/road_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "msgs/frames.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr std::size_t thinning = 5;  // points of 2 m between nodes

// A smooth displacement with zero mean: a sum of waves of random directions, with wavelengths of
// 1.5 to 4 correlation lengths.
class ShiftField {
 public:
  ShiftField(const MapErrors& errors, std::uint64_t seed) {
    Random random(seed, 14);
    for (Wave& wave : waves_) {
      const double length = errors.correlation * random.uniform(1.5, 4.0);
      const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double number = 2.0 * std::numbers::pi / length;
      wave.number = number * Eigen::Vector2d(std::cos(direction), std::sin(direction));
      wave.phase = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double towards = random.uniform(0.0, 2.0 * std::numbers::pi);
      // The variance of a sine is half the square of its amplitude.
      const double amplitude = errors.shift * std::sqrt(2.0 / static_cast<double>(waves_.size()));
      wave.shift = amplitude * Eigen::Vector2d(std::cos(towards), std::sin(towards));
    }
  }

  Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Wave& wave : waves_) sum += std::sin(wave.number.dot(p) + wave.phase) * wave.shift;
    return sum;
  }

 private:
  struct Wave {
    Eigen::Vector2d number, shift;
    double phase = 0.0;
  };
  std::array<Wave, 12> waves_;
};

long long way_id(std::size_t street) {
  return 10'000 + static_cast<long long>(street);
}

// A node of a street's centreline: the index of its point, and its id in the map.
struct WayNode {
  std::size_t point;
  long long id;
};

std::vector<WayNode> nodes_of(const Streets& streets, std::size_t number) {
  const Street& street = streets.streets[number];
  const std::size_t last = street.centreline.size() - 1;
  std::vector<WayNode> nodes{{0, 1'000 + static_cast<long long>(street.from)}};
  for (std::size_t i = thinning; i + thinning / 2 < last; i += thinning)
    nodes.push_back(
        {i, 1'000'000 + 10'000 * static_cast<long long>(number) + static_cast<long long>(i)});
  nodes.push_back({last, 1'000 + static_cast<long long>(street.to)});
  return nodes;
}

std::string node_line(long long id, const Eigen::Vector2d& place, const LocalFrame& frame) {
  const Geodetic g = frame.to_geodetic({place.x(), place.y(), 0.0});
  char text[128];
  std::snprintf(text, sizeof text,
                "  <node id=\"%lld\" version=\"1\" lat=\"%.9f\" lon=\"%.9f\"/>\n", id,
                degrees(g.latitude), degrees(g.longitude));
  return text;
}

std::string way_lines(long long id, const std::vector<long long>& nodes, const Street& street,
                      const char* oneway) {
  std::string text = "  <way id=\"" + std::to_string(id) + "\" version=\"1\">\n";
  for (const long long node : nodes) text += "    <nd ref=\"" + std::to_string(node) + "\"/>\n";
  const auto tag = [&text](const std::string& key, const std::string& value) {
    text += "    <tag k=\"" + key + "\" v=\"" + value + "\"/>\n";
  };
  tag("highway", street.half_width > 4.0 ? "tertiary" : "residential");
  tag("name", "Street " + std::to_string(id));
  tag("maxspeed", std::to_string(std::lround(3.6 * street.speed_limit)));
  if (oneway) tag("oneway", oneway);
  return text + "  </way>\n";
}

const char* oneway_tag(const Street& street) {
  if (street.forward == street.backward) return nullptr;
  return street.forward ? "yes" : "-1";
}

}  // namespace

void write_road_map(const std::filesystem::path& file, const Streets& streets,
                    const LocalFrame& frame, std::uint64_t seed, const MapErrors& errors) {
  const ShiftField shift(errors, seed);
  Random random(seed, 15);
  std::string nodes, ways;
  for (std::size_t i = 0; i < streets.junctions.size(); ++i) {
    const Eigen::Vector2d& p = streets.junctions[i];
    nodes += node_line(1'000 + static_cast<long long>(i), p + shift(p), frame);
  }
  for (std::size_t i = 0; i < streets.streets.size(); ++i) {
    const Street& street = streets.streets[i];
    const bool wrong = random.chance(errors.wrong);
    const std::uint32_t how = random.below(3);
    const auto elsewhere = random.below(static_cast<std::uint32_t>(streets.junctions.size()));
    if (wrong && how == 0) continue;  // missing
    std::vector<long long> ids;
    for (const WayNode& node : nodes_of(streets, i)) {
      ids.push_back(node.id);
      const Eigen::Vector2d& p = street.centreline[node.point];
      if (node.id >= 1'000'000) nodes += node_line(node.id, p + shift(p), frame);
    }
    const char* oneway = oneway_tag(street);
    if (wrong && how == 1) {
      const bool ahead = random.chance(0.5);
      const bool against = street.forward == street.backward ? ahead : street.backward;
      oneway = against ? "yes" : "-1";
    }
    ways += way_lines(way_id(i), ids, street, oneway);
    if (!wrong || how != 2 || elsewhere == street.from) continue;
    // Adds a street that does not exist.
    ways += way_lines(
        way_id(i) + 5'000,
        {1'000 + static_cast<long long>(street.from), 1'000 + static_cast<long long>(elsewhere)},
        street, nullptr);
  }
  write_file(file,
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
             "<osm version=\"0.6\" generator=\"maploop simulate\">\n" +
                 nodes + ways + "</osm>\n");
}

void write_driven_links(const std::filesystem::path& file, const Streets& streets,
                        const VehicleMotion& motion, const std::vector<double>& times) {
  constexpr double near_junction = 15.0;  // m
  const auto& stretches = motion.path().stretches();
  std::string text = "frame,way_id,node_a,node_b,conf\n";
  std::size_t at = 0;
  for (std::size_t frame = 0; frame < times.size(); ++frame) {
    const double way = motion.way(times[frame]);
    while (at + 1 < stretches.size() && way > stretches[at].end) ++at;
    const LanePath::Stretch& stretch = stretches[at];
    const Street& street = streets.streets[stretch.street.street];
    const double share = (way - stretch.begin) / (stretch.end - stretch.begin);
    const double along = street.length() * (stretch.street.forward ? share : 1.0 - share);
    const auto nodes = nodes_of(streets, stretch.street.street);
    std::size_t i = 1;
    while (i + 1 < nodes.size() && street.along[nodes[i].point] < along) ++i;
    long long a = nodes[i - 1].id, b = nodes[i].id;
    if (!stretch.street.forward) std::swap(a, b);
    const bool certain = std::min(along, street.length() - along) > near_junction;
    text += std::to_string(frame) + ',' + std::to_string(way_id(stretch.street.street)) + ',' +
            std::to_string(a) + ',' + std::to_string(b) + ',' + (certain ? '1' : '0') + '\n';
  }
  write_file(file, text);
}

}  // namespace maploop::simulate
