#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "runtime/core/utc_discipline.h"
#include "runtime/vehicle/config/live_config.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "tools/command/json_output.h"
#include "tools/command/terminal.h"
#include "tools/replay/figures.h"
#include "tools/sensors/sensors.h"

namespace maploop::tools {
namespace {

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
  while (!interrupted() && clock.now() < end) {
    if (!source.wait(sample, std::chrono::milliseconds(50))) continue;
    if (heard.samples++ == 0) heard.first = sample.stamp;
    heard.last = sample.stamp;
    const Duration age = sample.available - sample.stamp;
    heard.youngest = std::min(heard.youngest, age);
    heard.oldest = std::max(heard.oldest, age);
  }
  heard.report = source.report();
}

std::string samples_text(const Heard& heard) {
  const sensors::ConnectionState& connection = heard.report.connection;
  if (heard.samples == 0) {
    return connection.open && connection.bytes == 0
               ? "none: nothing is sent to there; is the sensor on, and set to this address?"
               : "none";
  }
  const double span = to_seconds(heard.last - heard.first);
  const double rate = span > 0.0 ? static_cast<double>(heard.samples - 1) / span : 0.0;
  return fmt::format("{}, {:.2f} Hz, delivered {:.1f} to {:.1f} ms after their stamp",
                     heard.samples, rate, to_milliseconds(heard.youngest),
                     to_milliseconds(heard.oldest));
}

void print(const Heard& heard) {
  const sensors::ConnectionState& connection = heard.report.connection;
  fmt::print("{}  {}\n", heard.name, heard.report.endpoint);
  fmt::print("  connection   {}; opened {} times, {} bytes\n",
             connection.open ? "open" : connection.problem, connection.opened, connection.bytes);
  fmt::print("  samples      {}\n", samples_text(heard));
  for (const std::string& reason : heard.report.reasons) {
    fmt::print("  left out     {}\n", reason);
  }
  for (const std::string& note : heard.report.notes) fmt::print("  says         {}\n", note);
  const SensorClock& clock = heard.report.clock;
  if (!clock.known) return;
  fmt::print("  clock        {:+.1f} ppm against the host's, jumped {} times{}\n",
             -1e6 * clock.drift, clock.jumps,
             clock.utc_ahead ? fmt::format("; its UTC is {:+.3f} s ahead of the host's",
                                           to_seconds(*clock.utc_ahead))
                             : "");
}

nlohmann::json to_json(const Heard& heard) {
  const sensors::ConnectionState& connection = heard.report.connection;
  nlohmann::json json{{"endpoint", heard.report.endpoint}, {"open", connection.open},
                      {"problem", connection.problem},     {"opened", connection.opened},
                      {"bytes", connection.bytes},         {"samples", heard.samples},
                      {"refused", heard.report.refused},   {"left_out", heard.report.reasons},
                      {"notes", heard.report.notes}};
  if (heard.report.clock.known) json["clock"] = web::to_json(clock_columns, heard.report.clock);
  if (heard.samples > 0) {
    json["span_s"] = to_seconds(heard.last - heard.first);
    json["youngest_s"] = to_seconds(heard.youngest);
    json["oldest_s"] = to_seconds(heard.oldest);
  }
  return json;
}

vehicle::VehicleConfig config_of(const ListenOptions& options) {
  if (!options.config.empty()) return vehicle::load_vehicle_config(options.config);
  vehicle::VehicleConfig config;
  config.live = options.live;
  config.vehicle.lidar = options.lidar;
  if (options.gnss_protocol) config.live.gnss_protocol = *options.gnss_protocol;
  if (config.live.velodyne.empty() && config.live.imu.empty() && config.live.gnss.empty()) {
    throw CLI::RequiredError("one of --velodyne, --imu and --gnss");
  }
  return config;
}

}  // namespace

int listen_to_sensors(const ListenOptions& options) {
  vehicle::LiveSensors live = vehicle::open_live_sensors(config_of(options));
  const sensors::HostClock& clock = *live.clock;
  const Time end = clock.now() + from_seconds(options.seconds);
  std::deque<Heard> heard;
  std::vector<std::function<void()>> listeners;
  listeners.reserve(6);
  const auto add = [&]<class T>(const char* name,
                                const std::unique_ptr<sensors::LiveSource<T>>& source) {
    if (source == nullptr) return;
    Heard& h = heard.emplace_back();
    h.name = name;
    listeners.push_back([&source, &clock, end, &h] { listen(*source, clock, end, h); });
  };
  add("camera", live.camera);
  add("velodyne", live.velodyne);
  add("imu", live.imu);
  add("gnss", live.gnss);
  add("gnss", live.epochs);
  add("corrections", live.corrections);
  note_interrupts();
  {
    std::vector<std::jthread> threads;
    threads.reserve(listeners.size());
    for (const auto& listener : listeners) threads.emplace_back(listener);
  }
  bool all = true;
  nlohmann::json json;
  for (const Heard& h : heard) {
    print(h);
    json[h.name] = to_json(h);
    all = all && h.samples > 0;
  }
  if (const Duration step = clock.step(); std::chrono::abs(step) > std::chrono::milliseconds(10)) {
    fmt::print("this machine's clock was set by {:+.3f} s meanwhile; stamps did not follow it\n",
               to_seconds(step));
  }
  if (const RealtimeSetting utc = runtime::assess_utc(); utc.verdict != Verdict::granted) {
    fmt::print("{}\n", runtime::to_sentence(utc));
  }
  if (!options.json.empty()) write_json_file(options.json, json);
  return all ? 0 : 1;
}

}  // namespace maploop::tools
