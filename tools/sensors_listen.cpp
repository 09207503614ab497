#include "tools/sensors_listen.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "sensors/live/live_sensors.h"
#include "tools/json_output.h"

namespace maploop::tools {
namespace {

std::atomic<bool> interrupted{false};  // lock-free, as a signal handler needs it

// What one sensor delivered.
struct Heard {
  std::string name;
  std::uint64_t samples = 0;
  Time first{}, last{};                           // stamps
  Duration youngest = Duration::max(), oldest{};  // age at delivery
  sensors::LiveReport report;
};

template <class T>
void listen(sensors::LiveSource<T>& source, const sensors::HostClock& clock, Time end,
            Heard& heard) {
  T sample{};
  while (!interrupted && clock.now() < end) {
    if (!source.wait(sample, std::chrono::milliseconds(50))) continue;
    if (heard.samples++ == 0) heard.first = sample.stamp;
    heard.last = sample.stamp;
    const Duration age = sample.available - sample.stamp;
    heard.youngest = std::min(heard.youngest, age);
    heard.oldest = std::max(heard.oldest, age);
  }
  heard.report = source.report();
}

void print(const Heard& heard) {
  const sensors::ConnectionState& connection = heard.report.connection;
  std::printf("%s  %s\n", heard.name.c_str(), heard.report.endpoint.c_str());
  std::printf("  connection   %s; opened %llu times, %llu bytes\n",
              connection.open ? "open" : connection.problem.c_str(),
              static_cast<unsigned long long>(connection.opened),
              static_cast<unsigned long long>(connection.bytes));
  if (heard.samples == 0) {
    std::printf("  samples      none%s\n",
                connection.open && connection.bytes == 0
                    ? ": nothing is sent to there; is the sensor on, and set to this address?"
                    : "");
  } else {
    const double span = to_seconds(heard.last - heard.first);
    const double rate = span > 0.0 ? static_cast<double>(heard.samples - 1) / span : 0.0;
    std::printf("  samples      %llu, %.2f Hz, delivered %.1f to %.1f ms after their stamp\n",
                static_cast<unsigned long long>(heard.samples), rate,
                1e3 * to_seconds(heard.youngest), 1e3 * to_seconds(heard.oldest));
  }
  for (const std::string& reason : heard.report.reasons) {
    std::printf("  left out     %s\n", reason.c_str());
  }
  for (const std::string& note : heard.report.notes)
    std::printf("  says         %s\n", note.c_str());
}

nlohmann::json to_json(const Heard& heard) {
  const sensors::ConnectionState& connection = heard.report.connection;
  nlohmann::json json{{"endpoint", heard.report.endpoint}, {"open", connection.open},
                      {"problem", connection.problem},     {"opened", connection.opened},
                      {"bytes", connection.bytes},         {"samples", heard.samples},
                      {"refused", heard.report.refused},   {"left_out", heard.report.reasons},
                      {"notes", heard.report.notes}};
  if (heard.samples > 0) {
    json["span_s"] = to_seconds(heard.last - heard.first);
    json["youngest_s"] = to_seconds(heard.youngest);
    json["oldest_s"] = to_seconds(heard.oldest);
  }
  return json;
}

std::vector<sensors::Laser> lasers(sensors::VelodyneModel model,
                                   const std::filesystem::path& calibration) {
  return calibration.empty() ? sensors::factory_lasers(model)
                             : sensors::read_velodyne_calibration(calibration, model);
}

}  // namespace

int listen_to_sensors(const ListenOptions& options) {
  const sensors::HostClock clock;
  const Time end = clock.now() + from_seconds(options.seconds);
  std::vector<Heard> heard;
  heard.reserve(3);
  std::vector<std::function<void()>> listeners;
  const auto add = [&]<class T>(const char* name, std::shared_ptr<sensors::LiveSource<T>> source) {
    Heard& h = heard.emplace_back();
    h.name = name;
    listeners.push_back([source, &clock, end, &h] { listen(*source, clock, end, h); });
  };
  if (!options.velodyne.empty()) {
    sensors::LiveVelodyneOptions velodyne{sensors::parse_endpoint(options.velodyne), {}, {}, {}};
    if (!options.velodyne_position.empty()) {
      velodyne.position = sensors::parse_endpoint(options.velodyne_position);
    }
    velodyne.model = sensors::velodyne_model(options.model).value();
    velodyne.lasers = lasers(velodyne.model, options.calibration);
    add("velodyne", std::shared_ptr(sensors::listen_to_velodyne(std::move(velodyne), clock)));
  }
  if (!options.imu.empty()) {
    add("imu", std::shared_ptr(sensors::listen_to_ncom(sensors::parse_endpoint(options.imu),
                                                       Duration::zero(), clock)));
  }
  if (!options.gnss.empty()) {
    add("gnss",
        std::shared_ptr(sensors::listen_to_nmea(sensors::parse_endpoint(options.gnss), {}, clock)));
  }
  if (listeners.empty()) {
    throw CLI::RequiredError("one of --velodyne, --imu and --gnss");
  }
  interrupted = false;
  const auto interrupt = [](int) { interrupted = true; };
  const auto before = std::signal(SIGINT, interrupt);
  const auto terminate_before = std::signal(SIGTERM, interrupt);
  {
    std::vector<std::jthread> threads;
    for (const auto& listener : listeners) threads.emplace_back(listener);
  }
  std::signal(SIGINT, before);
  std::signal(SIGTERM, terminate_before);
  bool all = true;
  nlohmann::json json;
  for (const Heard& h : heard) {
    print(h);
    json[h.name] = to_json(h);
    all = all && h.samples > 0;
  }
  if (const Duration step = clock.step(); std::chrono::abs(step) > std::chrono::milliseconds(10)) {
    std::printf("this machine's clock was set by %+.3f s meanwhile; stamps did not follow it\n",
                to_seconds(step));
  }
  if (!options.json.empty()) write_json_file(options.json, json);
  return all ? 0 : 1;
}

}  // namespace maploop::tools
