#include "runtime/vehicle/faults/fault_injection.h"

#include <concepts>
#include <optional>
#include <utility>

#include "runtime/vehicle/faults/fault_source.h"

namespace maploop::vehicle {
namespace {

// Returns what a fault does to one sample, for the kinds that only change samples.
template <class T>
std::function<void(T&)> alteration(const Fault& fault) {
  const Duration by = fault.by;
  switch (fault.kind) {
    case FaultKind::late:
      return [by](T& sample) { sample.available += by; };
    case FaultKind::jump:
      return [by](T& sample) { shift_stamps(sample, by); };
    default:
      break;
  }
  if constexpr (requires(T & sample) { repeat(sample, sample); }) {
    if (fault.kind == FaultKind::frozen) {
      return [first = std::optional<T>()](T& sample) mutable {
        if (!first) first = sample;
        repeat(sample, *first);
      };
    }
  }
  if constexpr (!std::same_as<T, StereoPair>) {
    return [](T& sample) { fill_with_nan(sample); };
  } else if (fault.kind == FaultKind::black) {
    return [](T& pair) { blacken(pair); };
  } else {
    return [seed = fault.seed](T& pair) { scramble(pair, seed); };
  }
}

}  // namespace

FaultInjection::FaultInjection(std::vector<Fault> faults, Time origin) {
  for (Fault& fault : faults) {
    Injected& injected = faults_.emplace_back();
    injected.window = window(fault, origin);
    injected.fault = std::move(fault);
  }
}

template <class T>
std::unique_ptr<sensors::Source<T>> FaultInjection::with_fault(
    std::unique_ptr<sensors::Source<T>> source, Injected& injected) {
  if (source == nullptr) return nullptr;
  const Fault& fault = injected.fault;
  switch (fault.kind) {
    case FaultKind::lost:
      return std::make_unique<LosingSource<T>>(std::move(source), fault, injected.window,
                                               injected.struck);
    case FaultKind::duplicated:
      return std::make_unique<DuplicatingSource<T>>(std::move(source), fault, injected.window,
                                                    injected.struck);
    case FaultKind::reordered:
      return std::make_unique<ReorderingSource<T>>(std::move(source), fault, injected.window,
                                                   injected.struck);
    default:
      return std::make_unique<AlteringSource<T>>(std::move(source), fault, injected.window,
                                                 injected.struck, alteration<T>(fault));
  }
}

Sensors FaultInjection::inject(Sensors sensors) {
  for (Injected& injected : faults_) {
    const auto strike = [&](auto& source) { source = with_fault(std::move(source), injected); };
    switch (injected.fault.target) {
      case FaultTarget::camera:
        strike(sensors.camera);
        break;
      case FaultTarget::velodyne:
        strike(sensors.velodyne);
        break;
      case FaultTarget::imu:
        strike(sensors.imu);
        break;
      case FaultTarget::gnss:
        strike(sensors.gnss);
        strike(sensors.epochs);
        break;
      case FaultTarget::stereo:
      case FaultTarget::lidar:
      case FaultTarget::ppp:
      case FaultTarget::fusion:
      case FaultTarget::mapmatch:
      case FaultTarget::cpu:
        break;  // these are not sensors
    }
  }
  return sensors;
}

StageDelays FaultInjection::delays() {
  StageDelays delays;
  for (Injected& injected : faults_) {
    const bool slows = injected.fault.kind == FaultKind::slow;
    if (!slows && injected.fault.kind != FaultKind::broken) continue;
    StageDelay& delay = delays[std::string(target_name(injected.fault.target))];
    if (slows) {
      delay.add(injected.window, injected.fault.by, injected.struck);
    } else {
      delay.add_end(injected.window, injected.struck);
    }
  }
  return delays;
}

std::vector<std::unique_ptr<CpuHog>> FaultInjection::hogs(const std::function<Time()>& position) {
  std::vector<std::unique_ptr<CpuHog>> hogs;
  for (Injected& injected : faults_) {
    if (injected.fault.kind != FaultKind::hog) continue;
    hogs.push_back(std::make_unique<CpuHog>(injected.fault.threads, injected.window, position,
                                            injected.struck));
  }
  return hogs;
}

std::vector<FaultCount> FaultInjection::counts() const {
  std::vector<FaultCount> counts;
  for (const Injected& injected : faults_) {
    counts.push_back({injected.fault.text, injected.struck.load(std::memory_order_relaxed)});
  }
  return counts;
}

}  // namespace maploop::vehicle
