#include "runtime/vehicle/vehicle.h"

#include <algorithm>
#include <utility>

#include "runtime/core/periodic.h"
#include "runtime/core/realtime.h"
#include "runtime/vehicle/vehicle_graph.h"

namespace maploop::vehicle {

Vehicle::Vehicle(const VehicleConfig& config, const VehicleCalibration& calibration,
                 Sensors sensors, const runtime::DataClock& clock, std::vector<MessageSink*> sinks,
                 Observer observer, runtime::Tracer* tracer, std::shared_ptr<const RoadMap> map)
    : graph_(std::make_unique<Graph>(config, calibration, std::move(sensors), clock,
                                     std::move(sinks), std::move(observer), tracer,
                                     std::move(map))) {}

Vehicle::~Vehicle() = default;

void Vehicle::slow_down(StageDelays delays) {
  graph_->stereo.slow_down(std::move(delays.stereo));
  if (graph_->lidar) graph_->lidar->slow_down(std::move(delays.lidar));
  if (graph_->ppp) graph_->ppp->slow_down(std::move(delays.ppp));
  graph_->fusion.slow_down(std::move(delays.fusion));
  if (graph_->mapmatch) graph_->mapmatch->slow_down(std::move(delays.mapmatch));
}

void Vehicle::start_from(const fusion::KnownStart& known) {
  const fusion::Outcome outcome = graph_->fusion.start_from(known);
  if (outcome.refused()) {
    throw std::invalid_argument("the filter cannot start from these values: " +
                                std::string(to_string(outcome.reason)));
  }
}

void Vehicle::take_snapshots(std::vector<Time> moments, SnapshotHandler handler) {
  for (Time& t : moments) t = runtime::first_tick(t, stages::fusion.period);
  graph_->wishes.push_back({{moments.begin(), moments.end()}, std::move(handler)});
}

void Vehicle::resume(const Snapshot& snapshot) {
  if (graph_->lidar.has_value() == snapshot.lidar.empty()) {
    throw ArchiveError(snapshot.lidar.empty()
                           ? "it was saved without LiDAR odometry, and here there is one"
                           : "it was saved with LiDAR odometry, and here there is none");
  }
  if (graph_->ppp.has_value() == snapshot.ppp.empty()) {
    throw ArchiveError(snapshot.ppp.empty()
                           ? "it was saved without GNSS observations, and here there are some"
                           : "it was saved with GNSS observations, and here there are none");
  }
  if (graph_->mapmatch.has_value() == snapshot.mapmatch.empty()) {
    throw ArchiveError(snapshot.mapmatch.empty()
                           ? "it was saved without a map, and here there is one"
                           : "it was saved with a map, and here there is none");
  }
  if (graph_->lidar) graph_->lidar->resume(snapshot.lidar);
  if (graph_->ppp) graph_->ppp->resume(snapshot.ppp);
  if (graph_->mapmatch) graph_->mapmatch->resume(snapshot.mapmatch);
  graph_->stereo.resume(snapshot.stereo);
  graph_->fusion.resume(snapshot.fusion);
  graph_->resumed = Snapshot{snapshot.at, snapshot.first, {}, {}, {}, {}, {}};
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
  return graph_->fusion.position();
}
Time Vehicle::first() const {
  return graph_->first;
}

namespace {

// A driver promises up to just before its next sample.
Time next_of(const runtime::EdgeBase& edge) {
  const Time promised = edge.promised();
  return promised == Time::max() ? promised : promised + Duration(1);
}

}  // namespace

// Of a drive without images its GNSS epochs or scans stand for them.
Time Vehicle::next_image() const {
  if (graph_->to_ppp && graph_->drivers.camera->absent()) return next_of(graph_->to_ppp->epochs);
  if (graph_->to_lidar && graph_->drivers.camera->absent()) return next_of(graph_->to_lidar->scans);
  return next_of(graph_->odometry_recorded
                     ? static_cast<const runtime::EdgeBase&>(graph_->to_fusion.odometry)
                     : graph_->images);
}

Time Vehicle::next_sample() const {
  const Time epoch = graph_->to_ppp ? next_of(graph_->to_ppp->epochs) : Time::max();
  return std::min({next_image(), epoch, next_of(graph_->to_fusion.imu),
                   next_of(graph_->to_fusion.gnss), next_of(graph_->to_fusion.wheel),
                   next_of(graph_->to_publisher.reference)});
}

std::uint64_t Vehicle::deadline_misses() const {
  const std::uint64_t lidar = graph_->lidar ? graph_->lidar->meter().latency().miss_count() : 0;
  const std::uint64_t ppp = graph_->ppp ? graph_->ppp->meter().latency().miss_count() : 0;
  return graph_->stereo.meter().latency().miss_count() + lidar + ppp +
         graph_->fusion.meter().latency().miss_count() +
         (graph_->mapmatch ? graph_->mapmatch->meter().latency().miss_count() : 0);
}

runtime::DataClock& Vehicle::clock() {
  return graph_->clock;
}

}  // namespace maploop::vehicle