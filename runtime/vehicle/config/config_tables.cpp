#include "runtime/vehicle/config/config_tables.h"

namespace maploop::vehicle {
namespace {

using namespace std::string_view_literals;

constexpr std::array odometries{"visual"sv, "visual-lidar"sv};
constexpr std::array imu_grades{"tactical"sv, "mems"sv};
constexpr std::array imu_noises{"recorded"sv, "mems"sv};
constexpr std::array imu_protocols{"ncom"sv, "lines"sv, "xsens"sv};

}  // namespace

ParameterTable<VehicleConfig> top_level_table() {
  using enum Audience;
  using P = VehicleConfig;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"lcm_url", &P::lcm_url, usual,
       "Where messages go, unless --lcm-url states it. Empty: to LCM_DEFAULT_URL of the "
       "environment, or else to udpm://239.255.76.67:7667?ttl=0, which stays on this host."},
      {"configuration", &P::configuration, usual,
       "What is combined with the reduced inertial sensors: auto, which is all that is there; or "
       "VO-RI, VO-L-RI, RISS, RISS-VO or RI, or one of them after GNSS+; or GNSS alone "
       "(estimators/fusion/configuration.h). It sets `odometry` and the keys use_..., speed_..., "
       "and still_by_inertia of [fusion]; these keys override it."},
      {"imu_grade", &P::imu_grade, usual,
       "Noise of the inertial sensors. It sets keys of [fusion], which override it.", imu_grades},
      {"odometry", &P::odometry, usual,
       "Odometry that the fusion uses; \"visual-lidar\" has an effect where there is a LiDAR.",
       odometries},
  });
  return {"", "", table};
}

ParameterTable<VehicleConfig> gnss_outage_table() {
  using enum Audience;
  using P = VehicleConfig;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"outage", &P::gnss_outage, usual,
       "Times without fixes: START:LENGTH[,...] in seconds from the start of the drive, where "
       "LENGTH may be \"end\"; repeated:START:LENGTH, with a minute between; or "
       "random:COUNT:LENGTH. Empty: none."},
  });
  return {"gnss", "", table};
}

ParameterTable<VehicleConfig> imu_table() {
  using enum Audience;
  using P = VehicleConfig;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"noise", &P::imu_noise, usual,
       "\"mems\": the noise of a MEMS unit is added to the recorded samples "
       "(sensors/replay/imu_noise.h).",
       imu_noises},
      {"errors", one_of<&P::imu_errors>, usual,
       "\"drawn\": the seed draws the size of that noise, and the filter is not told."},
      {"seed", &P::imu_seed, -2147483648.0, 2147483647.0, "1", usual,
       "Another seed gives another realization."},
  });
  return {"imu", "Noise added to the recorded inertial samples.", table};
}

ParameterTable<PreviewParameters> parameter_table(const PreviewParameters&) {
  using enum Audience;
  using P = PreviewParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"rate", &P::rate, 0.0, 5.0, "Hz", usual,
       "Pictures and scans per second of the machine's clock. 0: none."},
      {"width", &P::width, 64, 1280, "px", usual, "Width of the picture at most."},
      {"quality", &P::quality, 1, 100, "1", usual, "Quality of the JPEG picture."},
      {"points", &P::points, 0, 20'000, "points", usual, "Points of the scan at most."},
  });
  return {"preview",
          "Pictures and scans for dashboards (channel PREVIEW), where messages are published.",
          table};
}

ParameterTable<VehicleConfig> vehicle_file_table() {
  using enum Audience;
  using P = VehicleConfig;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"file", &P::vehicle_file, usual,
       "File with these tables, as maploop vehicle writes it, whose values hold where this file "
       "has none; the path starts from this file's folder. Empty: none."},
  });
  return {"vehicle", parameter_table(CarDescription{}).meaning, table};
}

ParameterTable<LiveParameters> parameter_table(const LiveParameters&) {
  using enum Audience;
  using P = LiveParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"camera_left", &P::camera_left, usual,
       "GStreamer pipeline of the left camera, such as v4l2src device=/dev/video0 ! "
       "video/x-raw,width=1280,height=720"},
      {"camera_right", &P::camera_right, usual,
       "GStreamer pipeline of the right camera. Empty: the images of the left one show both "
       "cameras side by side."},
      {"velodyne", &P::velodyne, usual, "Endpoint of the data packets, such as udp://:2368"},
      {"velodyne_position", &P::velodyne_position, usual,
       "Endpoint of the position packets, such as udp://:8308, from which the UTC of the receiver "
       "is reported."},
      {"imu", &P::imu, usual,
       "Endpoint of the inertial unit, such as udp://:3000. With \"ncom\" it must be udp."},
      {"imu_protocol", &P::imu_protocol, usual,
       "\"ncom\": an OXTS unit; \"xsens\": MTData2 with acceleration, rate of turn and "
       "SampleTimeFine; \"lines\": text $PIMU,s,m/s^2 forward,m/s^2 left,rad/s*checksum, or with "
       "the other three axes (sensors/README.md)",
       imu_protocols},
      {"gnss", &P::gnss, usual,
       "Endpoint of a receiver: serial:///dev/gnss?baud=115200, tcp:// or udp://; of observations "
       "also ntrip://USER:PASSWORD@HOST:2101/MOUNTPOINT, or ntrips:// over TLS."},
      {"gnss_protocol", one_of<&P::gnss_protocol>, usual,
       "\"nmea\": the receiver's own fixes; \"ubx\": the same as NAV-PVT; \"observations\": UBX "
       "(RAWX, SFRBX) or RTCM 3 (MSM4 to MSM7, ephemerides), told apart by content, for precise "
       "point positioning."},
      {"gnss_latency", &P::gnss_latency, 0.0, 60.0, "s", usual,
       "Time from an epoch to the end of its transmission, at least."},
      {"gnss_frequencies", &P::gnss_frequencies, 1, 2, "frequencies", usual,
       "Frequencies of the observations. With 1, the ionosphere is modelled."},
      {"gnss_antenna", &P::gnss_antenna, usual,
       "Antenna of the observations: NAME, or NAME RADOME, of an ANTEX file of [ppp] products. "
       "Empty: not known."},
      {"corrections", &P::corrections, usual,
       "Endpoint of corrections of the observations: RTCM 3 with ephemerides and SSR (orbits, "
       "clocks and code biases of RTCM and of the IGS), as `gnss`."},
  });
  return {
      "live",
      "maploop live. Endpoints: udp://[ADDRESS]:PORT (without an address only this host), "
      "tcp://ADDRESS:PORT, serial:///dev/NAME?baud=115200. Empty: the vehicle has no such sensor.",
      table};
}

ParameterTable<PppConfig> parameter_table(const PppConfig&) {
  using enum Audience;
  using P = PppConfig;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"observations", &P::observations, usual,
       "Whether the observations of a drive (its folder gnss) take the place of the receiver of "
       "[gnss]."},
      {"products", &P::products, usual,
       "Files and folders of navigation messages, SP3 orbits, clocks, antennas, biases and more; "
       "paths start from this file's folder. Empty: the folder of the observations."},
      {"broadcast", &P::broadcast, usual,
       "Whether orbits and clocks of the navigation message are used even where SP3 is given."},
      {"latency", &P::latency, 0.0, 10.0, "s", usual,
       "Time from an epoch to its delivery by the receiver."},
      {"integrity_risk", &P::integrity_risk, 1e-12, 0.5, "1", usual,
       "Probability of an error at one epoch beyond its protection level."},
      {"heights", &P::heights, usual,
       "The height of the ground: a tile of SRTM (N49E011.hgt, .hgt.gz or .hgt.zip) or a folder of "
       "them; the path starts from this file's folder. Empty: not used."},
      {"geoid", &P::geoid, usual,
       "What these heights count from: a grid of the geoid (GTX); the path starts from this file's "
       "folder. Empty: EGM96, as SRTM, where Debian's proj-data is installed. \"none\": the "
       "ellipsoid."},
  });
  return {"ppp",
          "Precise point positioning with the observations of a GNSS receiver (RINEX). Standard "
          "deviations are those of one carrier at the zenith.",
          table};
}

ParameterTable<OverloadParameters> parameter_table(const OverloadParameters&) {
  using enum Audience;
  using P = OverloadParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"shed", one_of<&P::shed>, usual,
       "What a live vehicle uses less of when odometry does not keep its deadlines: "
       "\"scans-first\": of scans every second point, then every second image pair; "
       "\"images-first\": the reverse; \"nothing\": samples are lost."},
      {"shed_at", &P::shed_at, 0.01, 10.0, "1", expert,
       "Share of its deadline above which a step of odometry takes too long."},
      {"restore_at", &P::restore_at, 0.0, 10.0, "1", expert,
       "Share of its deadline below which there is room for more."},
  });
  return {"overload", "What is left out when the computer is too slow.", table};
}

ParameterTable<MapParameters> parameter_table(const MapParameters&) {
  using enum Audience;
  using P = MapParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"file", &P::file, usual,
       "OpenStreetMap file (.osm.pbf, .osm), or network file or tiled map of maploop map build; "
       "the "
       "path starts from this file's folder. Empty: no map."},
      {"mode", one_of<&P::mode>, usual,
       "\"none\": no matching; \"loose\": matched, nothing is fed back; \"tight\": the road "
       "corrects the filter; \"hard-reset\": position and azimuth become the matched ones."},
      {"side_of_road", one_of<&P::side_of_road>, usual,
       "Side on which traffic keeps, if it is not that of [vehicle]. A one-way street whose "
       "opposite carriageway is on the wrong side may be driven both ways, as its direction is "
       "doubtful."},
      {"rules", &P::rules, usual,
       "Folder of fuzzy rule bases (.fll); the path starts from this file's folder. Empty: those "
       "that are shipped."},
  });
  return {"map", "The map and its use.", table};
}

}  // namespace maploop::vehicle
