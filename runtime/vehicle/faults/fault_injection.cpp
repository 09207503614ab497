#include "runtime/vehicle/faults/fault_injection.h"

#include <chrono>
#include <concepts>
#include <stdexcept>
#include <stop_token>
#include <utility>

#include "runtime/core/data_clock.h"

namespace maploop::vehicle {
namespace {

// This takes about a tenth of a millisecond of one core.
void compute_nothing() {
  constexpr int steps = 100'000;
  for (int i = 0; i < steps; ++i) std::atomic_signal_fence(std::memory_order_seq_cst);
}

// A part of a sensor is struck where the sensor is.
FaultTarget sensor_of(FaultTarget target) {
  const bool of_imu = target == FaultTarget::gyro || target == FaultTarget::accelerometer;
  return of_imu ? FaultTarget::imu : target;
}

bool is_of_fixes(FaultKind kind) {
  return kind == FaultKind::bias || kind == FaultKind::drift || kind == FaultKind::spoofed;
}

void be_busy(const std::stop_token& stop, ActiveFault& active,
             const std::function<Time()>& position) {
  while (position() < active.window.begin) {
    if (stop.stop_requested()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const MonotonicTime last = runtime::monotonic_now() + longest_hog;
  active.struck.fetch_add(1, std::memory_order_relaxed);
  while (position() < active.window.end && !stop.stop_requested() &&
         runtime::monotonic_now() < last) {
    compute_nothing();
  }
}

}  // namespace

FaultInjection::FaultInjection(std::vector<Fault> faults, Time origin, double focal_length) {
  for (Fault& fault : faults) {
    ActiveFault& active = faults_.emplace_back();
    active.window = window(fault, origin);
    active.focal_length = focal_length;
    active.fault = std::move(fault);
  }
}

Sensors FaultInjection::inject(Sensors sensors) {
  for (ActiveFault& active : faults_) {
    const auto strike = [&]<class T>(FaultTarget target,
                                     std::unique_ptr<sensors::Source<T>>& source) {
      if (source == nullptr || sensor_of(active.fault.target) != target) return;
      if (std::same_as<T, GnssEpoch> && is_of_fixes(active.fault.kind)) {
        throw std::invalid_argument(
            "fault '" + active.fault.text +
            "': the recording has observations, which have no position to strike; --set "
            "ppp.observations=false replays fixes in their place");
      }
      source = std::make_unique<FaultySource<T>>(std::move(source), active);
    };
    strike(FaultTarget::camera, sensors.camera);
    strike(FaultTarget::velodyne, sensors.velodyne);
    strike(FaultTarget::imu, sensors.imu);
    strike(FaultTarget::gnss, sensors.gnss);
    strike(FaultTarget::gnss, sensors.epochs);
    strike(FaultTarget::wheel, sensors.wheel);
  }
  return sensors;
}

StageDelays FaultInjection::delays() {
  StageDelays delays;
  for (ActiveFault& active : faults_) {
    const bool slows = active.fault.kind == FaultKind::slow;
    if (!slows && active.fault.kind != FaultKind::broken) continue;
    StageDelay& delay = delays[std::string(target_name(active.fault.target))];
    if (slows) {
      delay.add(active.window, from_seconds(active.fault.by), active.struck);
    } else {
      delay.add_end(active.window, active.struck);
    }
  }
  return delays;
}

std::vector<std::jthread> FaultInjection::hogs(const std::function<Time()>& position) {
  std::vector<std::jthread> threads;
  for (ActiveFault& active : faults_) {
    if (active.fault.kind != FaultKind::hog) continue;
    for (int i = 0; i < active.fault.threads; ++i) {
      threads.emplace_back(
          [&active, position](const std::stop_token& stop) { be_busy(stop, active, position); });
    }
  }
  return threads;
}

std::vector<FaultCount> FaultInjection::counts() const {
  std::vector<FaultCount> counts;
  for (const ActiveFault& active : faults_) {
    counts.push_back({active.fault.text, active.struck.load(std::memory_order_relaxed)});
  }
  return counts;
}

}  // namespace maploop::vehicle
