// Connects the player to LCM: commands arrive and its state is sent, both on REPLAY_CONTROL.
#pragma once

#include <string>

#include "msgs/time.h"
#include "runtime/vehicle/playback/player.h"

namespace lcm {
class LCM;
class Subscription;
struct ReceiveBuffer;
}  // namespace lcm

namespace maploop::vehicle {

// Obeys the commands that name its run, and ignores those that name another. A command that cannot
// be obeyed, or names no run, is refused, and the next state contains the reason. A state is sent
// on each change and after each command, five times a second while the position changes, and once a
// second otherwise. Only the player's thread may use this; `lcm` and `player` must outlive it.
class ReplayControl {
 public:
  // `run` is the id of the run (runs.h).
  ReplayControl(lcm::LCM& lcm, Player& player, std::string run);
  ~ReplayControl();
  ReplayControl(const ReplayControl&) = delete;
  ReplayControl& operator=(const ReplayControl&) = delete;

  // Obeys the commands that have arrived, and sends the state if it has changed. Never blocks.
  void update();

  bool quit() const { return quit_; }  // a command asked for the end

 private:
  void take(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  // Returns why the command is refused, or an empty string if it was obeyed.
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
  lcm::Subscription* subscription_;  // owned by lcm_
  std::string refused_;
  bool answer_due_ = true;
  bool quit_ = false;
  Said said_;
  MonotonicTime said_at_{};
};

}  // namespace maploop::vehicle
