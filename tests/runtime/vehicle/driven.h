// Drives a vehicle from the start to the end, and keeps what it sent.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/vehicle/faults/fault_injection.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "runtime/vehicle/output/channel_hashes.h"
#include "tests/runtime/vehicle/fake_sensors.h"
#include "tests/support/message_tape.h"

namespace maploop::vehicle::testing {

using maploop::testing::MessageTape;

// A drive to run; members that are not given keep the values of the default configuration.
struct Drive {
  Sensors sensors;
  double speed = 0.0;  // of the data clock; 0: virtual time
  VehicleConfig config = {};
  VehicleCalibration calibration = fake_calibration();
  std::shared_ptr<const RoadMap> map = nullptr;
  std::vector<Time> cuts = {};     // where snapshots are taken
  const Snapshot* from = nullptr;  // where the drive goes on from
  const Bytes* ppp = nullptr;      // the filter of an earlier run
  std::vector<std::string> faults = {};
  Time faults_from = drive_start;        // what the windows of the faults count from
  std::vector<MessageSink*> sinks = {};  // besides those that keep what is sent
  runtime::RealtimeReport prepared = {};
  std::function<void(const NavState&)> look = nullptr;
};

struct Driven {
  VehicleReport report;
  std::map<std::string, ChannelSummary> channels;
  MessageTape::Channels messages;
  std::vector<NavState> states;
  std::vector<MapMatch> matches;
  std::vector<MapFeedback> feedbacks;
  std::vector<PppState> ppp;
  std::vector<RelativeMotion> motions;
  std::vector<Snapshot> snapshots;
  std::vector<FaultCount> faults;

  // By channel; those about the run have none.
  std::map<std::string, std::string> hashes() const {
    std::map<std::string, std::string> all;
    for (const auto& [name, channel] : channels) {
      if (!channel.hash.empty()) all[name] = channel.hash;
    }
    return all;
  }
  std::uint64_t refused(const std::string& stage, const std::string& reason) const {
    for (const RefusalCount& r : report.health.refusals) {
      if (r.stage == stage && r.reason == reason) return r.count;
    }
    return 0;
  }
  std::string failure(const std::string& thread) const {
    for (const ThreadHealth& t : report.health.threads) {
      if (t.name == thread) return t.failure;
    }
    return "there is no such thread";
  }
};

// Waits for the end of a vehicle, as long as it makes progress.
inline void expect_end(Vehicle& vehicle) {
  constexpr Duration longest_pause = std::chrono::minutes(2);
  Time position = vehicle.position();
  MonotonicTime moved = runtime::monotonic_now();
  while (vehicle.running() && runtime::monotonic_now() < moved + longest_pause) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (std::exchange(position, vehicle.position()) != position) moved = runtime::monotonic_now();
  }
  EXPECT_FALSE(vehicle.running());
  vehicle.stop();
  vehicle.wait();
}

inline Driven drive(Drive d) {
  std::vector<Fault> faults;
  for (const std::string& text : d.faults) faults.push_back(parse_fault(text));
  FaultInjection injection(std::move(faults), d.faults_from, d.calibration.stereo.fx);
  const auto clock =
      d.speed > 0.0 ? runtime::DataClock::paced(d.speed) : runtime::DataClock::virtual_time();
  Driven driven;
  ChannelHashes hashes;
  MessageTape tape;
  std::vector<MessageSink*> sinks{&hashes, &tape};
  sinks.insert(sinks.end(), d.sinks.begin(), d.sinks.end());
  Observer observer;
  observer.nav_state = [&](const NavState& state) {
    driven.states.push_back(state);
    if (d.look) d.look(state);
  };
  observer.map_match = [&](const MapMatch& match) { driven.matches.push_back(match); };
  observer.map_feedback = [&](const MapFeedback& f) { driven.feedbacks.push_back(f); };
  observer.ppp = [&](const PppState& state) { driven.ppp.push_back(state); };
  observer.odometry = [&](const RelativeMotion& motion) { driven.motions.push_back(motion); };
  Vehicle vehicle(d.config, d.calibration, injection.inject(std::move(d.sensors)), clock, sinks,
                  observer, nullptr, d.map);
  vehicle.prepared(d.prepared);
  vehicle.slow_down(injection.delays());
  if (d.from != nullptr) vehicle.resume(*d.from);
  if (d.ppp != nullptr) vehicle.recall(stages::ppp, *d.ppp);
  if (!d.cuts.empty())
    vehicle.take_snapshots(d.cuts, [&](const Snapshot& s) { driven.snapshots.push_back(s); });
  const auto hogs = injection.hogs([&] { return vehicle.position(); });
  vehicle.start();
  expect_end(vehicle);
  driven.report = vehicle.report();
  driven.channels = hashes.summary();
  driven.messages = tape.all();
  driven.faults = injection.counts();
  return driven;
}

// Every ring has passed on what it got; with `all` it has kept and lost nothing.
inline void expect_rings_balance(const VehicleReport& report, bool all = false) {
  for (const RingHealth& ring : report.health.rings) {
    EXPECT_EQ(ring.pushed, ring.popped + ring.lost + ring.held) << ring.name;
    if (all) {
      EXPECT_EQ(ring.lost + ring.held, 0u) << ring.name;
    }
  }
}

// The vehicle that goes on from each snapshot sends what `whole` sent from there on; drive_from(s)
// drives it.
template <class DriveFrom>
void expect_resumes(const Driven& whole, DriveFrom drive_from) {
  for (const Snapshot& snapshot : whole.snapshots) {
    EXPECT_EQ(drive_from(&snapshot).messages, maploop::testing::after(whole.messages, snapshot.at))
        << "from " << format_time(snapshot.at);
  }
}

}  // namespace maploop::vehicle::testing
