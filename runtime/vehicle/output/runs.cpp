#include "runtime/vehicle/output/runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <maploop_lcm/run_t.hpp>
#include <random>
#include <span>
#include <utility>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "runtime/core/data_clock.h"
#include "runtime/vehicle/output/lcm_bus.h"

namespace maploop::vehicle {
namespace {

constexpr Duration say_every = std::chrono::seconds(1);
constexpr Duration silent_after = std::chrono::seconds(3);
constexpr std::size_t max_runs = 16;  // a flooded channel takes no more memory
constexpr std::size_t longest_what = 100;

const std::string run_channel(channel_names::run);

bool is_id(const std::string& text) {
  return text.size() == 8 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

Run new_run(std::string what) {
  return {fmt::format("{:08x}", std::random_device{}() & 0xffffffffU), std::move(what)};
}

std::string to_text(const Run& run) {
  std::string what = run.what;
  std::replace_if(
      what.begin(), what.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
  return run.id + " (" + what + ")";
}

void RunsHeard::take(const maploop_lcm::run_t& message, Duration now) {
  if (!is_id(message.id)) return;
  if (message.ended != 0) {
    runs_.erase(message.id);
    return;
  }
  std::erase_if(runs_, [&](const auto& run) { return now - run.second.at > silent_after; });
  if (runs_.size() < max_runs || runs_.contains(message.id)) {
    runs_[message.id] = {message.what.substr(0, longest_what), now};
  }
}

std::vector<Run> RunsHeard::present(Duration now) const {
  std::vector<Run> all;
  for (const auto& [id, heard] : runs_) {
    if (now - heard.at <= silent_after) all.push_back({id, heard.what});
  }
  return all;
}

RunPresence::RunPresence(lcm::LCM& lcm, Run run, std::function<void(const std::string&)> warn)
    : lcm_(lcm),
      run_(std::move(run)),
      warn_(std::move(warn)),
      subscription_(lcm.subscribe(run_channel, &RunPresence::take, this)) {}

RunPresence::~RunPresence() {
  lcm_.unsubscribe(subscription_);
  say(true);
}

void RunPresence::take(const lcm::ReceiveBuffer* buffer, const std::string&) {
  maploop_lcm::run_t message{};
  const std::span data(static_cast<const std::uint8_t*>(buffer->data), buffer->data_size);
  if (!schema::checked_decode(schema::own_schema(), data, message) || message.id == run_.id) return;
  others_.take(message, runtime::monotonic_now().time_since_epoch());
}

void RunPresence::say(bool ended) {
  maploop_lcm::run_t message{};
  message.machine_utime = std::chrono::floor<std::chrono::microseconds>(
                              std::chrono::system_clock::now().time_since_epoch())
                              .count();
  message.id = run_.id;
  message.what = run_.what;
  message.ended = ended ? 1 : 0;
  if (ended) message.verdict = verdict_;
  lcm_.publish(run_channel, &message);
}

void RunPresence::update() {
  hear_waiting(lcm_);
  const MonotonicTime now = runtime::monotonic_now();
  if (now >= next_) {
    say(false);
    next_ = now + say_every;
  }
  if (warned_) return;
  if (const auto others = others_.present(now.time_since_epoch()); !others.empty()) {
    warned_ = true;
    warn_("another run publishes on this bus, " + to_text(others.front()) +
          ": listeners receive the messages of both; give one run its own bus, such as "
          "--lcm-url udpm://239.255.76.67:7668?ttl=0");
  }
}

}  // namespace maploop::vehicle
