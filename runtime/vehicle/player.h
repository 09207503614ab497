// Plays a replay: pause, step, speed, seek, next deadline miss.
#pragma once

#include <cstdint>

#include "runtime/vehicle/vehicle.h"

namespace maploop::vehicle {

// Only moves the data clock: what is computed stays the same, bit for bit. One thread's own, the
// one that also calls update() every few tens of milliseconds. For a vehicle on a paced clock.
class Player {
 public:
  explicit Player(Vehicle& vehicle) : vehicle_(vehicle) {}

  void pause();
  void resume();
  // To the release of the next image, or of the next sample of any sensor; then paused.
  void step_image();
  void step_sample();
  void set_speed(double speed) { vehicle_.clock().set_speed(speed); }

  // Goes through what lies before t as fast as the graph can; the state at t is the one of having
  // driven there. False when t is behind: what has been computed cannot be taken back.
  bool seek(Time t);

  // Goes on until another deadline is missed, then pauses.
  void play_to_next_miss();

  void update();

  bool paused() const { return vehicle_.clock().paused(); }
  bool seeking() const { return seeking_; }
  double speed() const { return vehicle_.clock().speed(); }

 private:
  Vehicle& vehicle_;
  bool seeking_ = false;
  bool pause_on_arrival_ = false;
  Time target_{};
  bool until_miss_ = false;
  std::uint64_t misses_before_ = 0;
};

}  // namespace maploop::vehicle
