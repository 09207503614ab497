// The player on LCM: commands come in, its state goes out, both on REPLAY_CONTROL.
#pragma once

#include <string>

#include "msgs/time.h"
#include "runtime/vehicle/player.h"

namespace lcm {
class LCM;
class Subscription;
struct ReceiveBuffer;
}  // namespace lcm

namespace maploop::vehicle {

// Obeys the commands that name its run; those for others it does not answer. One that cannot be
// obeyed, or names none, is refused, with its reason in the next state. States are sent on
// each change and after each command; while it plays, five times a second for the position. The
// player's thread's own; `lcm` and `player` must outlive it.
class ReplayControl {
 public:
  // `run`: its id (runs.h).
  ReplayControl(lcm::LCM& lcm, Player& player, std::string run);
  ~ReplayControl();
  ReplayControl(const ReplayControl&) = delete;
  ReplayControl& operator=(const ReplayControl&) = delete;

  // Obeys what has come, and says what has changed. Never waits.
  void update();

  bool quit() const { return quit_; }  // asked for

 private:
  void take(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  // Why not; empty: obeyed.
  std::string obey(int kind, double value);
  void say();

  struct Said {
    bool paused = false;
    bool seeking = false;
    double speed = 0.0;
    Time position{};
    bool operator==(const Said&) const = default;
  };

  lcm::LCM& lcm_;
  Player& player_;
  std::string run_;
  lcm::Subscription* subscription_;  // of lcm_
  std::string refused_;
  bool answer_due_ = true;
  bool quit_ = false;
  Said said_;
  MonotonicTime said_at_{};
};

}  // namespace maploop::vehicle
