#include "runtime/vehicle/playback/replay_control.h"

#include <fmt/format.h>

#include <lcm/lcm-cpp.hpp>
#include <maploop_lcm/replay_control_t.hpp>
#include <span>
#include <stdexcept>
#include <utility>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "runtime/core/data_clock.h"
#include "runtime/vehicle/output/lcm_bus.h"

namespace maploop::vehicle {
namespace {

using Control = maploop_lcm::replay_control_t;

constexpr Duration position_every = std::chrono::milliseconds(200);
// A program that joins late, or lost a message, learns the state of a paused run within this time.
constexpr Duration state_every = std::chrono::seconds(1);

const std::string channel(channel_names::replay_control);

}  // namespace

ReplayControl::ReplayControl(lcm::LCM& lcm, Player& player, std::string run)
    : lcm_(lcm),
      player_(player),
      run_(std::move(run)),
      subscription_(lcm.subscribe(channel, &ReplayControl::take, this)) {}

ReplayControl::~ReplayControl() {
  lcm_.unsubscribe(subscription_);
}

void ReplayControl::take(const lcm::ReceiveBuffer* buffer, const std::string&) {
  Control command{};
  const std::span data(static_cast<const std::uint8_t*>(buffer->data), buffer->data_size);
  if (!schema::checked_decode(schema::own_schema(), data, command)) {
    refused_ = "not a message of type replay_control_t of this version";
  } else if (command.kind == Control::STATE) {
    return;  // this is our own state, or another run's
  } else if (command.run.empty()) {
    refused_ = "the command has no run; this run is " + run_;
  } else if (command.run != run_) {
    return;
  } else {
    refused_ = obey(command.kind, command.value);
  }
  answer_due_ = true;
}

std::string ReplayControl::obey(int kind, double value) {
  switch (kind) {
    case Control::PAUSE:
      player_.pause();
      return {};
    case Control::RESUME:
      player_.resume();
      return {};
    case Control::STEP_SAMPLE:
      player_.step_sample();
      return {};
    case Control::STEP_IMAGE:
      player_.step_image();
      return {};
    case Control::SEEK: {
      const double length = to_seconds(player_.last() - player_.first());
      if (value >= 0.0 && value <= length && player_.seek(player_.first() + from_seconds(value))) {
        return {};
      }
      return fmt::format("seek to {:g} s: the drive goes from 0 s to {:g} s", value, length);
    }
    case Control::SPEED:
      try {
        player_.set_speed(value);
        return {};
      } catch (const std::invalid_argument& e) {
        return e.what();
      }
    case Control::NEXT_MISS:
      player_.play_to_next_miss();
      return {};
    case Control::QUIT:
      quit_ = true;
      player_.quit();
      return {};
    default:
      return "unknown command " + std::to_string(kind);
  }
}

void ReplayControl::update() {
  hear_waiting(lcm_);
  say();
}

void ReplayControl::say() {
  Said now{player_.paused(), player_.seeking(), player_.speed(), said_.position};
  const MonotonicTime at = runtime::monotonic_now();
  if (now != said_ || answer_due_ || at - said_at_ >= position_every) {
    now.position = player_.position();
  }
  if (now == said_ && !answer_due_ && at - said_at_ < state_every) return;
  Control state{};
  state.utime =
      std::chrono::floor<std::chrono::microseconds>(now.position).time_since_epoch().count();
  state.kind = Control::STATE;
  state.run = run_;
  state.paused = now.paused ? 1 : 0;
  state.seeking = now.seeking ? 1 : 0;
  state.speed = now.speed;
  state.position_ns = to_nanoseconds(now.position);
  state.first_ns = to_nanoseconds(player_.first());
  state.last_ns = to_nanoseconds(player_.last());
  state.refused = refused_;
  lcm_.publish(channel, &state);
  said_ = now;
  said_at_ = at;
  answer_due_ = false;
}

}  // namespace maploop::vehicle
