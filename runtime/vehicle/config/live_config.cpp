#include "runtime/vehicle/config/live_config.h"

#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ppp/gnss_files.h"
#include "runtime/vehicle/config/config_tables.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/live_gnss.h"
#include "runtime/vehicle/drivers/stereo_rig_file.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "sensors/live/live_sensors.h"
#include "sensors/live/ntrip_client.h"

namespace maploop::vehicle {
namespace {

// Returns make(); an error of it is thrown again with the key of [live] that it concerns.
template <class Make>
auto of_key(const char* key, Make&& make) {
  try {
    return make();
  } catch (const std::exception& e) {
    throw std::runtime_error(std::string("[live] ") + key + ": " + e.what());
  }
}

sensors::LiveVelodyneOptions velodyne_options(const LiveParameters& p,
                                              const LidarDescription& lidar) {
  sensors::LiveVelodyneOptions options{sensors::parse_endpoint(p.velodyne), {}, {}, {}};
  if (!p.velodyne_position.empty()) {
    options.position = sensors::parse_endpoint(p.velodyne_position);
  }
  options.model = sensors::velodyne_model(lidar.model).value();
  options.lasers = lidar.calibration.empty()
                       ? sensors::factory_lasers(options.model)
                       : sensors::read_velodyne_calibration(lidar.calibration, options.model);
  return options;
}

// Returns the setup; the pointer also owns the files that the setup refers to.
std::shared_ptr<const ppp::PppSetup> live_ppp(const VehicleConfig& config) {
  struct Products {
    ppp::GnssFiles files;
    std::optional<ppp::PppSetup> setup;
  };
  const LiveParameters& p = config.live;
  const auto products = std::make_shared<Products>();
  for (const std::string& product : config.ppp.products) {
    ppp::read_products(product, products->files);
  }
  const std::size_t space = p.gnss_antenna.find(' ');
  products->setup.emplace(
      products->files, setup_options(config.ppp),
      ppp::LiveReceiver{p.gnss_frequencies == 1, p.gnss_antenna.substr(0, space),
                        space == std::string::npos ? "" : p.gnss_antenna.substr(space + 1)});
  return {products, &*products->setup};
}

std::optional<sensors::StereoRig> rig_of(const VehicleConfig& config) {
  const std::string& file = config.vehicle.camera.calibration;
  return file.empty() ? std::nullopt : std::optional(read_stereo_rig(file));
}

sensors::LiveStereoOptions camera_options(const VehicleConfig& config) {
  const LiveParameters& p = config.live;
  sensors::LiveStereoOptions options{p.camera_left,
                                     p.camera_right,
                                     0,
                                     0,
                                     rig_of(config),
                                     from_seconds(config.vehicle.camera.time.delay),
                                     from_seconds(config.replay.max_pair_skew)};
  if (options.rig) {
    options.width = options.rig->width;
    options.height = options.rig->height;
  } else {
    options.width = config.vehicle.camera.width;
    options.height = config.vehicle.camera.height;
  }
  return options;
}

}  // namespace

VehicleCalibration live_calibration(const VehicleConfig& config) {
  VehicleCalibration calibration;
  if (const auto rig = rig_of(config)) calibration.stereo = rig->rectified;
  calibration.stereo.T_body_cam = camera_pose({}, {});
  return described(config, calibration);
}

LiveSensors open_live_sensors(const VehicleConfig& config) {
  const LiveParameters& p = config.live;
  const auto check = [](const auto& table, const auto& values) {
    const auto problem = problem_of(table, values);
    if (!problem) return;
    throw std::runtime_error('[' + std::string(table.name) + "] " + std::string(problem->key) +
                             ": " + problem->text);
  };
  check(parameter_table(p), p);
  each_table(check, config.vehicle);
  LiveSensors s;
  s.clock = std::make_shared<const sensors::HostClock>();
  if (!p.camera_left.empty()) {
    s.camera = of_key("camera_left",
                      [&] { return sensors::listen_to_cameras(camera_options(config), *s.clock); });
  } else if (!p.camera_right.empty()) {
    throw std::runtime_error("[live] camera_right needs camera_left too: set both, or neither");
  }
  if (!p.velodyne.empty()) {
    s.velodyne = of_key("velodyne", [&] {
      return sensors::listen_to_velodyne(velodyne_options(p, config.vehicle.lidar), *s.clock);
    });
  }
  if (!p.imu.empty()) {
    s.imu = of_key("imu", [&] {
      const sensors::Endpoint endpoint = sensors::parse_endpoint(p.imu);
      const Duration delay = from_seconds(config.vehicle.imu.time.delay);
      if (p.imu_protocol == "lines") return sensors::listen_to_imu_lines(endpoint, delay, *s.clock);
      if (p.imu_protocol == "xsens") return sensors::listen_to_xsens(endpoint, delay, *s.clock);
      return sensors::listen_to_ncom(endpoint, delay, *s.clock);
    });
  }
  if (!p.gnss.empty() && p.gnss_protocol == GnssProtocol::observations) {
    s.epochs = of_key("gnss", [&] {
      return listen_to_receiver(sensors::open_stream(p.gnss), from_seconds(p.gnss_latency),
                                *s.clock);
    });
    s.ppp = live_ppp(config);
    if (!p.corrections.empty()) {
      s.corrections = of_key("corrections", [&] {
        return listen_to_corrections(sensors::open_stream(p.corrections), *s.clock);
      });
    }
  } else if (!p.gnss.empty() && p.gnss_protocol == GnssProtocol::ubx) {
    s.gnss = of_key("gnss", [&] {
      return listen_to_fixes(sensors::open_stream(p.gnss), from_seconds(p.gnss_latency), *s.clock);
    });
  } else if (!p.gnss.empty()) {
    s.gnss = of_key("gnss", [&] {
      sensors::NmeaParameters nmea;
      nmea.latency = p.gnss_latency;
      return sensors::listen_to_nmea(sensors::parse_endpoint(p.gnss), nmea, *s.clock);
    });
  }
  if (!p.corrections.empty() && !s.corrections) {
    throw std::runtime_error(
        "[live] corrections needs observations to correct: set gnss to a receiver, and "
        "gnss_protocol to \"observations\"");
  }
  if (!s.camera && !s.velodyne && !s.imu && !s.gnss && !s.epochs) {
    throw std::runtime_error(
        "the configuration has no live sensor: set [live] camera_left to a pipeline, or velodyne, "
        "imu or gnss to an endpoint such as udp://:2368");
  }
  return s;
}

}  // namespace maploop::vehicle
