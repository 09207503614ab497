// Plays a recording: pause, step, speed, seek both ways, loop, next deadline miss.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "runtime/vehicle/snapshot_ring.h"
#include "runtime/vehicle/vehicle.h"

namespace maploop::vehicle {

struct PlayerParameters {
  Time first{};  // of the recording, or where its replay resumes
  Time last{};   // of the recording
  Time start{};  // each pass goes up to there as fast as the graph can
  Duration snapshot_every = std::chrono::seconds(2);  // half of it is computed again, on average
  std::size_t snapshots = 16;                         // some 1 MB each; 0: going back starts again
  std::uint64_t passes = 1;                           // the recording is played so often
};

// Moves the data clock, and to go back builds the vehicle anew from a snapshot: what is computed
// stays the same, bit for bit, as in a run that came there directly. What lies between the snapshot
// and the target is sent again. One thread's own, the one that also calls update() every few tens
// of milliseconds; position() is for any thread. On virtual time nothing but passes has an effect.
class Player {
 public:
  // Makes a vehicle of the recording, not started: from its start, or from a snapshot. When it is
  // called, the vehicle before has ended.
  using Maker = std::function<std::unique_ptr<Vehicle>(const Snapshot* from)>;

  Player(Maker make, const PlayerParameters& parameters);

  // Makes and starts the first vehicle; throws what Vehicle::start() throws. Before all else.
  void start();

  // During a seek these two say what happens on arrival, and the steps do nothing.
  void pause();
  void resume();
  // To the release of the next image, or of the next sample of any sensor; then paused.
  void step_image();
  void step_sample();
  // Throws std::invalid_argument unless speed is finite and above 0.
  void set_speed(double speed);

  // Goes through what lies before t as fast as the graph can; the state at t is the one of having
  // driven there. False when t is outside of the recording.
  bool seek(Time t);

  // Goes on until another deadline is missed, then pauses.
  void play_to_next_miss();

  // Ends the last pass at once.
  void quit();

  // Whether it still plays; begins the next pass where one has ended.
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
