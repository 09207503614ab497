#include "sensors/velodyne/turn_assembler.h"

#include <cmath>
#include <utility>

namespace maploop::sensors {
namespace {

constexpr double full = velodyne_full_turn;

// An HDL-64E at 5 turns a second with dual returns has 440 000 points a turn.
constexpr std::size_t max_points = 480'000;

}  // namespace

TurnAssembler::TurnAssembler(Duration max_turn) : max_turn_(max_turn) {
  turn_.points.reserve(max_points);
}

void TurnAssembler::interrupt() {
  if (inside_) ++counts_.broken;
  inside_ = follows_ = false;
}

void TurnAssembler::begin_turn(Time start) {
  turn_.points.clear();
  turn_.times.clear();
  turn_.start = start;
  inside_ = true;
  stamped_ = false;
}

// Returns when the scanner passed `at` between the previous point and this one, by interpolation.
Time TurnAssembler::crossing(double at, double angle, Time time) const {
  const double share = (at - last_angle_) / (angle - last_angle_);
  return last_time_ + from_seconds(share * to_seconds(time - last_time_));
}

bool TurnAssembler::close(Time end, LidarScan& done) {
  const bool complete = inside_ && stamped_ && !turn_.points.empty();
  if (complete) {
    turn_.end = end;
    turn_.sequence = sequence_;
    ++counts_.complete;
    counts_.points += turn_.points.size();
    std::swap(turn_, done);
    turn_.points.reserve(max_points);
  } else if (inside_) {
    ++counts_.broken;
  } else {
    ++counts_.begun_midway;
  }
  ++sequence_;
  return complete;
}

bool TurnAssembler::add(const FiredPoint& fired, Time time, LidarScan& done) {
  const double phase = std::fmod(fired.azimuth + full / 2.0, full);
  bool ended = false;
  if (follows_) {
    const double step = std::remainder(phase - last_angle_, full);
    const bool too_long = inside_ && time - turn_.start > max_turn_;
    if (std::fabs(step) > full / 4.0 || too_long) {
      interrupt();
    } else {
      const double angle = last_angle_ + step;
      if (inside_ && !stamped_ && angle >= full / 2.0) {
        turn_.stamp = crossing(full / 2.0, angle, time);
        stamped_ = true;
      }
      if (angle >= full) {
        const Time rear = crossing(full, angle, time);
        ended = close(rear, done);
        begin_turn(rear);
        last_angle_ = angle - full;
      } else {
        last_angle_ = angle;
      }
    }
  }
  if (!follows_) last_angle_ = phase;
  follows_ = true;
  last_time_ = time;
  if (inside_) {
    if (turn_.points.size() < max_points) {
      turn_.points.push_back(fired.point);
    } else {
      ++counts_.no_room;
    }
  }
  return ended;
}

}  // namespace maploop::sensors
