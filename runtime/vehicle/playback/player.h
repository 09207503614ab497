// Plays a recording with pause, step, speed, seek both ways, loop, and the next deadline miss.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "runtime/vehicle/graph/vehicle.h"
#include "runtime/vehicle/playback/snapshot_ring.h"

namespace maploop::vehicle {

struct PlayerParameters {
  Time first{};  // start of the recording, or where its replay resumes
  Time last{};   // end of the recording
  Time start{};  // each pass goes to this time as fast as the graph can
  Duration snapshot_every = std::chrono::seconds(2);  // a seek back repeats half of it, on average
  std::size_t snapshots = 16;  // kept at most (size: snapshot.h); 0: going back restarts
  std::uint64_t passes = 1;    // how often the recording is played
};

// Player controls the data clock, and rebuilds the vehicle from a snapshot to go back. The results
// are the same, bit for bit, as in a run that came there directly. Messages between the snapshot
// and the target are sent again. One thread uses the player and calls update() every few tens of
// milliseconds; any thread may call position(). On virtual time only `passes` and quit() apply.
class Player {
 public:
  // A Maker returns a vehicle of the recording, not started: at its start, or resumed from a
  // snapshot. The vehicle before has ended when it is called.
  using Maker = std::function<std::unique_ptr<Vehicle>(const Snapshot* from)>;

  Player(Maker make, const PlayerParameters& parameters);

  // Makes and starts the first vehicle; throws what Vehicle::start() throws. Must be called first.
  void start();

  // During a seek, pause() and resume() set what happens on arrival, and the steps do nothing.
  void pause();
  void resume();
  // Plays to the release of the next image, or of the next sample of any sensor, and pauses there.
  void step_image();
  void step_sample();
  // Throws std::invalid_argument unless speed is finite and above 0.
  void set_speed(double speed);

  // Computes everything before t as fast as the graph can, so that the state at t is that of having
  // driven there. Returns false if t is outside of the recording.
  bool seek(Time t);

  // Plays until another deadline is missed, then pauses.
  void play_to_next_miss();

  // Ends the last pass at once.
  void quit();

  // Begins the next pass if one has ended. Returns false when the last one has ended.
  bool update();

  bool paused() const { return !seeking_ && vehicle_->clock().paused(); }
  bool seeking() const { return seeking_; }
  double speed() const { return vehicle_->clock().speed(); }
  Time first() const { return parameters_.first; }
  Time last() const { return parameters_.last; }
  Time position() const { return from_nanoseconds(position_.load(std::memory_order_relaxed)); }
  Vehicle& vehicle() { return *vehicle_; }
  const Vehicle& vehicle() const { return *vehicle_; }

 private:
  void begin(const Snapshot* from);
  void begin_pass();
  void go_back(Time t);
  void step_to(Time t);
  void note_position();

  Maker make_;
  PlayerParameters parameters_;
  SnapshotRing snapshots_;
  std::unique_ptr<Vehicle> vehicle_;
  std::atomic<std::int64_t> position_{0};
  std::uint64_t passes_left_;
  bool quit_ = false;
  bool seeking_ = false;
  bool pause_on_arrival_ = false;
  Time target_{};
  bool until_miss_ = false;
  std::uint64_t misses_before_ = 0;
};

}  // namespace maploop::vehicle
