#include "runtime/vehicle/playback/player.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/vehicle/graph/graph.h"

namespace maploop::vehicle {

Player::Player(Maker make, const PlayerParameters& parameters)
    : make_(std::move(make)),
      parameters_(parameters),
      snapshots_(parameters.snapshots),
      passes_left_(parameters.passes) {}

void Player::start() {
  begin_pass();
}

void Player::begin_pass() {
  begin(nullptr);
  if (parameters_.start > parameters_.first && vehicle_->clock().is_paced()) {
    seek(parameters_.start);
  }
}

void Player::begin(const Snapshot* from) {
  vehicle_.reset();  // it uses the sinks and the tracer, which make_ replaces
  vehicle_ = make_(from);
  if (parameters_.snapshots > 0 && vehicle_->clock().is_paced()) {
    std::vector<Time> moments;
    for (Time t = parameters_.first + parameters_.snapshot_every; t < parameters_.last;
         t += parameters_.snapshot_every) {
      moments.push_back(t);
    }
    vehicle_->take_snapshots(std::move(moments),
                             [this](const Snapshot& snapshot) { snapshots_.add(snapshot); });
  }
  vehicle_->start();
  misses_before_ = 0;
  seeking_ = false;
  note_position();
}

// A vehicle has no position before its first tick.
void Player::note_position() {
  const Time position = std::max(parameters_.first, vehicle_->position());
  position_.store(to_nanoseconds(position), std::memory_order_relaxed);
}

void Player::pause() {
  until_miss_ = false;
  if (seeking_) {
    pause_on_arrival_ = true;
  } else if (!paused()) {
    vehicle_->clock().pause();
  }
}

void Player::resume() {
  if (seeking_) {
    pause_on_arrival_ = false;
  } else if (vehicle_->clock().pause_set()) {
    vehicle_->clock().resume();
  }
}

void Player::step_to(Time t) {
  until_miss_ = false;
  if (!seeking_) vehicle_->clock().resume_until(t);
}

void Player::step_image() {
  step_to(vehicle_->next_image());
}

void Player::step_sample() {
  step_to(vehicle_->next_sample());
}

void Player::set_speed(double speed) {
  vehicle_->clock().set_speed(speed);
}

bool Player::seek(Time t) {
  if (t < parameters_.first || t > parameters_.last) return false;
  const bool was_paused = seeking_ ? pause_on_arrival_ : vehicle_->clock().pause_set();
  if (t < vehicle_->position() || (seeking_ && t < target_)) go_back(t);
  pause_on_arrival_ = was_paused;
  vehicle_->clock().skip_to(t);
  seeking_ = true;
  target_ = t;
  return true;
}

void Player::go_back(Time t) {
  const double at_speed = speed();
  const std::optional<Snapshot> from = snapshots_.before(t);
  begin(from ? &*from : nullptr);
  set_speed(at_speed);
}

void Player::play_to_next_miss() {
  until_miss_ = true;
  misses_before_ = vehicle_->deadline_misses();
  resume();
}

void Player::quit() {
  quit_ = true;
  vehicle_->stop();
}

bool Player::update() {
  note_position();
  if (seeking_ && vehicle_->position() + stages::fusion.period >= target_) {
    seeking_ = false;
    vehicle_->clock().arrive(target_);
    if (!pause_on_arrival_) vehicle_->clock().resume();
  }
  if (until_miss_ && vehicle_->deadline_misses() > misses_before_) pause();
  if (vehicle_->running()) return true;
  if (quit_ || passes_left_ <= 1) return false;
  --passes_left_;
  const double at_speed = speed();
  begin_pass();
  if (vehicle_->clock().is_paced()) set_speed(at_speed);
  return true;
}

}  // namespace maploop::vehicle
