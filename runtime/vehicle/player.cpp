#include "runtime/vehicle/player.h"

#include "runtime/vehicle/graph.h"

namespace maploop::vehicle {

void Player::pause() {
  until_miss_ = false;
  if (!paused()) vehicle_.clock().pause();
}

void Player::resume() {
  if (paused()) vehicle_.clock().resume();
}

void Player::step_image() {
  const Time next = vehicle_.next_image();
  resume();
  vehicle_.clock().pause_at(next);
}

void Player::step_sample() {
  const Time next = vehicle_.next_sample();
  resume();
  vehicle_.clock().pause_at(next);
}

bool Player::seek(Time t) {
  if (t < vehicle_.position()) return false;
  pause_on_arrival_ = paused();
  resume();
  vehicle_.clock().skip_to(t);
  seeking_ = true;
  target_ = t;
  return true;
}

void Player::play_to_next_miss() {
  until_miss_ = true;
  misses_before_ = vehicle_.deadline_misses();
  resume();
}

void Player::update() {
  if (seeking_ && vehicle_.position() + stages::fusion.period >= target_) {
    seeking_ = false;
    vehicle_.clock().arrive(target_);
    if (pause_on_arrival_) vehicle_.clock().pause_at(target_);
  }
  if (until_miss_ && vehicle_.deadline_misses() > misses_before_) pause();
}

}  // namespace maploop::vehicle
