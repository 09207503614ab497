#include "runtime/vehicle/graph/vehicle.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/core/periodic.h"
#include "runtime/core/realtime.h"
#include "runtime/vehicle/graph/vehicle_graph.h"

namespace maploop::vehicle {

Vehicle::Vehicle(const VehicleConfig& config, const VehicleCalibration& calibration,
                 Sensors sensors, const runtime::DataClock& clock, std::vector<MessageSink*> sinks,
                 Observer observer, runtime::Tracer* tracer, std::shared_ptr<const RoadMap> map)
    : graph_(std::make_unique<Graph>(config, calibration, std::move(sensors), clock,
                                     std::move(sinks), std::move(observer), tracer,
                                     std::move(map))) {}

Vehicle::~Vehicle() = default;

void Vehicle::slow_down(const StageDelays& delays) {
  for (const auto& [name, delay] : delays) {
    if (GraphStage* stage = graph_->stage(name)) stage->slow_down(delay);
  }
}

void Vehicle::recall(const fusion::RememberedCalibration& remembered) {
  graph_->fusion->recall(remembered);
}

void Vehicle::recall(const fusion::LastPlace& place) {
  fusion::LastPlace known = place;
  // The filter of PPP starts anew, and so do the errors of its fixes.
  if (graph_->rings.has(stages::ppp)) known.forget_fixes();
  graph_->fusion->recall(known);
}

void Vehicle::recall(const StageSpec& stage, std::span<const std::uint8_t> saved) {
  if (GraphStage* there = graph_->stage(stage.name)) there->recall_saved(saved);
}

bool Vehicle::has(const StageSpec& stage) const {
  return graph_->rings.has(stage);
}

void Vehicle::start_from(const fusion::KnownStart& known) {
  const fusion::Outcome outcome = graph_->fusion->start_from(known);
  if (outcome.refused()) {
    throw std::invalid_argument("the filter cannot start from these values: " +
                                std::string(to_string(outcome.reason)));
  }
}

void Vehicle::take_snapshots(std::vector<Time> moments, SnapshotHandler handler) {
  for (Time& t : moments) t = runtime::first_tick(t, stages::fusion.period);
  graph_->snapshot_requests.push_back({{moments.begin(), moments.end()}, {}, std::move(handler)});
}

void Vehicle::take_snapshots(Duration every, SnapshotHandler handler) {
  const Duration tick = stages::fusion.period;
  graph_->snapshot_requests.push_back(
      {{}, (every + tick - Duration(1)) / tick * tick, std::move(handler)});
}

void Vehicle::resume(const Snapshot& snapshot) {
  const auto refuse = [](std::string_view stage, const char* then, const char* now) {
    std::string_view runs;
    for (const StageSpec& spec : stages::all) {
      if (spec.name == stage) runs = spec.runs;
    }
    throw ArchiveError("it was saved " + std::string(then) + ' ' + std::string(stage) + " (" +
                       std::string(runs) + "), and here the vehicle runs " + now + " it");
  };
  for (const auto& stage : graph_->stages) {
    const std::string_view name = stage->spec().name;
    if (snapshot.part(name) == nullptr) refuse(name, "without", "with");
  }
  for (const Snapshot::Part& part : snapshot.parts) {
    if (graph_->stage(part.stage) == nullptr) refuse(part.stage, "with", "without");
  }
  for (const auto& stage : graph_->stages) stage->resume(*snapshot.part(stage->spec().name));
  graph_->resumed = Snapshot{snapshot.at, snapshot.first, {}};
}

void Vehicle::prepared(const runtime::RealtimeReport& report) {
  runtime::append(graph_->readiness, report.settings);
}

const runtime::RealtimeReport& Vehicle::readiness() const {
  return graph_->readiness;
}

void Vehicle::start() {
  graph_->start();
}
void Vehicle::stop() {
  graph_->stop.request_stop();
}

bool Vehicle::running() const {
  return std::any_of(graph_->producers.begin(), graph_->producers.end(),
                     [](const runtime::Thread& thread) { return !thread.ended(); });
}

void Vehicle::wait() {
  graph_->wait();
}
VehicleReport Vehicle::report() const {
  return graph_->report();
}
Time Vehicle::position() const {
  return graph_->fusion->position();
}
Time Vehicle::first() const {
  return graph_->first;
}

namespace {

// A driver promises up to just before its next sample.
Time next_of(const DriverBase& driver) {
  const Time promised = driver.promised();
  return promised == Time::max() ? promised : promised + Duration(1);
}

}  // namespace

// In a drive without images its odometry, GNSS epochs or scans count in their place.
Time Vehicle::next_image() const {
  const bool epochs = graph_->rings.has(stages::ppp);
  const bool scans = graph_->rings.has(stages::lidar);
  for (const StageSpec* spec : {&stages::camera, epochs ? &stages::gnss : nullptr,
                                scans ? &stages::velodyne : nullptr, &stages::odometry}) {
    const DriverBase* driver = spec != nullptr ? graph_->driver(*spec) : nullptr;
    if (driver != nullptr) return next_of(*driver);
  }
  return Time::max();
}

Time Vehicle::next_sample() const {
  Time next = Time::max();
  for (const auto& driver : graph_->drivers) next = std::min(next, next_of(*driver));
  return next;
}

std::uint64_t Vehicle::deadline_misses() const {
  std::uint64_t misses = 0;
  for (const auto& stage : graph_->stages) misses += stage->meter().latency().miss_count();
  return misses;
}

runtime::DataClock& Vehicle::clock() {
  return graph_->clock;
}

}  // namespace maploop::vehicle