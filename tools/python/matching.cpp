// Road networks, recorded tracks, and the matcher.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mapmatch/lanes.h"
#include "mapmatch/matcher.h"
#include "mapmatch/network_file.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "tools/match/match_score.h"
#include "tools/match/track_file.h"
#include "tools/python/arrays.h"

namespace maploop::python {
namespace {

using mapmatch::RoadNetwork;
using mapmatch::VehicleFix;
using vehicle::VehicleConfig;

// Fields are VehicleFix's.
struct FixRecord {
  std::int64_t stamp;
  double latitude, longitude;
  double covariance[2][2];
  double speed, speed_sigma, azimuth, azimuth_sigma, yaw_rate, hdop, visual_speed, visual_azimuth;
};

FixRecord record_of(const VehicleFix& f) {
  return {to_nanoseconds(f.stamp),
          f.position.latitude,
          f.position.longitude,
          {{f.covariance(0, 0), f.covariance(0, 1)}, {f.covariance(1, 0), f.covariance(1, 1)}},
          f.speed,
          f.speed_sigma,
          f.azimuth,
          f.azimuth_sigma,
          f.yaw_rate,
          f.hdop,
          f.visual_speed,
          f.visual_azimuth};
}

VehicleFix fix_of(const FixRecord& r) {
  VehicleFix f;
  f.stamp = from_nanoseconds(r.stamp);
  f.position = {r.latitude, r.longitude, 0.0};
  f.covariance << r.covariance[0][0], r.covariance[0][1], r.covariance[1][0], r.covariance[1][1];
  f.speed = r.speed;
  f.speed_sigma = r.speed_sigma;
  f.azimuth = r.azimuth;
  f.azimuth_sigma = r.azimuth_sigma;
  f.yaw_rate = r.yaw_rate;
  f.hdop = r.hdop;
  f.visual_speed = r.visual_speed;
  f.visual_azimuth = r.visual_azimuth;
  return f;
}

struct MatchRecord {
  std::int64_t stamp;
  std::uint8_t refusal, phase;
  bool on_road;
  std::int64_t link;  // -1: on none
  bool forward;
  std::int64_t way_id, node_a, node_b;
  double along;
  double east, north, latitude, longitude;
  double azimuth;
  double likelihood, probability, margin, off_road;
  std::int32_t lanes, lane;  // 0: the map does not tell
  double lane_probability;
};

MatchRecord record_of(const mapmatch::MatchResult& m, const VehicleFix& fix,
                      const RoadNetwork& network, double lane_sigma) {
  MatchRecord r{};
  r.stamp = to_nanoseconds(m.stamp);
  r.refusal = static_cast<std::uint8_t>(m.refusal);
  r.phase = static_cast<std::uint8_t>(m.phase);
  r.on_road = m.on_road;
  r.link = -1;
  r.east = r.north = r.latitude = r.longitude = r.azimuth = mapmatch::unknown;
  r.off_road = m.off_road;
  if (!m.on_road) return r;
  const match::MatchedFix segment = match::matched_fix(m, network);
  r.link = m.link.link;
  r.forward = m.link.forward;
  r.way_id = segment.way_id.value_or(0);
  r.node_a = segment.node_a;
  r.node_b = segment.node_b;
  r.along = m.along;
  r.east = m.point.position.x();
  r.north = m.point.position.y();
  const Geodetic place = network.to_geodetic(m.point.position);
  r.latitude = place.latitude;
  r.longitude = place.longitude;
  r.azimuth = m.point.azimuth();
  r.likelihood = m.likelihood;
  r.probability = m.probability;
  r.margin = m.margin;
  const LanePosition lane = mapmatch::lane_on(
      network, m.link, m.point, network.to_local(fix.position), fix.covariance, lane_sigma);
  r.lanes = lane.lanes;
  r.lane = lane.lane;
  r.lane_probability = lane.probability;
  return r;
}

class PythonMatcher {
 public:
  PythonMatcher(std::shared_ptr<const RoadNetwork> network, const VehicleConfig& config)
      : network_(std::move(network)),
        rules_(mapmatch::read_rule_bases(config.map.rules.empty()
                                             ? mapmatch::default_rules()
                                             : std::filesystem::path(config.map.rules))),
        matcher_(*network_, rules_, config.mapmatch) {}

  py::array match(const py::array& fixes) {
    require_array<FixRecord>(fixes, "fixes", 1);
    const auto records = py::array_t<FixRecord, py::array::c_style>(fixes);
    const auto rows = records.unchecked<1>();
    return array_of(alone(mutex_, [&] {
      std::vector<MatchRecord> matches;
      for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
        const VehicleFix fix = fix_of(rows(i));
        matches.push_back(
            record_of(matcher_.add(fix), fix, *network_, matcher_.parameters().lane_sigma));
      }
      return matches;
    }));
  }

 private:
  std::shared_ptr<const RoadNetwork> network_;
  mapmatch::RuleBases rules_;
  std::mutex mutex_;
  mapmatch::Matcher matcher_;
};

std::shared_ptr<RoadNetwork> open_map(const std::filesystem::path& file,
                                      const std::optional<std::array<double, 4>>& box) {
  const py::gil_scoped_release released;
  mapmatch::OsmOptions options;
  if (box) options.box = {(*box)[0], (*box)[1], (*box)[2], (*box)[3]};
  return std::make_shared<RoadNetwork>(mapmatch::open_network(file, options));
}

Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> shape(const RoadNetwork& network,
                                                                std::size_t link) {
  if (link >= network.size()) {
    throw py::index_error("the network has " + std::to_string(network.size()) +
                          " links; there is no link " + std::to_string(link));
  }
  const auto vertices = network.shape(static_cast<std::uint32_t>(link));
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> rows(vertices.size(), 2);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = vertices[i].position().transpose();
  return rows;
}

py::array read_track(const std::filesystem::path& file, double sigma) {
  match::Track track;
  {
    const py::gil_scoped_release released;
    match::TrackOptions options;
    options.sigma = sigma;
    track = match::read_track(file, options);
  }
  std::vector<FixRecord> records;
  for (const VehicleFix& fix : track) records.push_back(record_of(fix));
  return array_of(std::move(records));
}

void add_dtypes(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(FixRecord, stamp, latitude, longitude, covariance, speed, speed_sigma,
                       azimuth, azimuth_sigma, yaw_rate, hdop, visual_speed, visual_azimuth);
  PYBIND11_NUMPY_DTYPE(MatchRecord, stamp, refusal, phase, on_road, link, forward, way_id, node_a,
                       node_b, along, east, north, latitude, longitude, azimuth, likelihood,
                       probability, margin, off_road, lanes, lane, lane_probability);
  module.attr("fix_dtype") = py::dtype::of<FixRecord>();
  module.attr("match_dtype") = py::dtype::of<MatchRecord>();
  module.attr("MATCH_PHASE") = names_tuple<MatchPhase>();
  module.attr("FIX_REFUSAL") = names_tuple<FixRefusal>();
}

}  // namespace

void add_matching(py::module_& module) {
  add_dtypes(module);
  py::class_<RoadNetwork, std::shared_ptr<RoadNetwork>>(
      module, "RoadNetwork",
      R"(The roads of a map, as links from junction to junction.

file: .osm.pbf, .osm (also .gz, .bz2), or a network file or tiled map of `maploop map build`.
box: west, south, east, north in degrees: only this part. Raises RuntimeError that names the file.)")
      .def(py::init(&open_map), py::arg("file"), py::arg("box") = py::none())
      .def("__len__", &RoadNetwork::size)
      .def("shape", &shape, py::arg("link"),
           "Returns (n, 2) m: east and north of a link's vertices. Raises IndexError.")
      .def(
          "to_local",
          [](const RoadNetwork& n, double latitude, double longitude) {
            return n.to_local({latitude, longitude, 0.0});
          },
          py::arg("latitude"), py::arg("longitude"),
          "Returns (2,) m: east and north of a place (rad).")
      .def_property_readonly(
          "warnings", [](const RoadNetwork& n) { return n.data().warnings; },
          "sentences: what of the map is left out");
  py::class_<PythonMatcher>(module, "Matcher", R"(Fuzzy map matching, fix by fix.

config: [mapmatch] and [map] rules of a Config.)")
      .def(py::init([](std::shared_ptr<RoadNetwork> network, const VehicleConfig& config) {
             return std::make_unique<PythonMatcher>(std::move(network), config);
           }),
           py::arg("network").none(false), py::arg("config") = VehicleConfig())
      .def("match", &PythonMatcher::match, py::arg("fixes"),
           R"(Returns (n,) match_dtype, one for each of (n,) fix_dtype, in the order of time.

It goes on from the last call, so that a vehicle can pass one fix at a time. A fix that cannot be
used is no error: refusal is its number in FIX_REFUSAL. Raises TypeError for another dtype.)");
  module.def("read_track", &read_track, py::arg("file"), py::arg("sigma") = 5.0,
             R"(Returns (n,) fix_dtype of a CSV, GPX, NMEA, TUM or LCM log file.

sigma: m an axis, of positions whose accuracy the file does not say. Raises RuntimeError.)");
  module.def(
      "unknown_fixes",
      [](std::size_t n) { return array_of(std::vector<FixRecord>(n, record_of(VehicleFix()))); },
      py::arg("n"), "Returns (n,) fix_dtype in which nothing is known, to be filled.");
}

}  // namespace maploop::python
