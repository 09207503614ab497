#include "tools/dashboard/relay.h"

#include <algorithm>
#include <array>
#include <maploop_lcm/replay_control_t.hpp>
#include <maploop_lcm/run_t.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "msgs/lcm/decoded_message.h"
#include "tools/dashboard/message_json.h"

namespace maploop::dashboard {
namespace {

using Control = maploop_lcm::replay_control_t;

constexpr std::size_t most_channels = 64;
constexpr std::size_t longest_verdict = 400;

// Texts may come from any sender, so that invalid UTF-8 is replaced.
std::string text_of(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool is_large(std::string_view channel) {
  return channel == channel_names::camera || channel == channel_names::velodyne;
}

}  // namespace

Relay::Relay(LiveChannels& channels) : channels_(channels), schema_(schema::own_types()) {}

void Relay::take(std::string_view channel, std::span<const std::uint8_t> data, Duration now) {
  if (is_large(channel)) return;
  const auto taken = [&](auto message, const auto& take) {
    if (schema::checked_decode(schema_, data, message)) take(message);
  };
  if (channel == channel_names::replay_control) {
    taken(Control{}, [&](const Control& c) {
      const auto runs = runs_.present(now);
      const auto same = [&](const vehicle::Run& run) { return run.id == c.run; };
      if (c.kind == Control::STATE && std::any_of(runs.begin(), runs.end(), same))
        players_[c.run].assign(data.begin(), data.end());
    });
    return;
  } else if (channel == channel_names::run) {
    taken(maploop_lcm::run_t{}, [&](const auto& run) {
      runs_.take(run, now);
      if (run.ended == 0 || run.verdict.empty()) return;
      channels_.put("VERDICT", text_of({{"id", run.id},
                                        {"what", run.what},
                                        {"lines", run.verdict.substr(0, longest_verdict)}}));
    });
    return;
  } else if (channel == channel_names::nav_state) {
    taken(maploop_lcm::nav_state_t{}, [&](const auto& m) {
      const std::lock_guard lock(trail_mutex_);
      trail_.add(from_lcm(m));
    });
  } else if (channel == channel_names::truth) {
    taken(maploop_lcm::reference_pose_t{}, [&](const auto& m) {
      const std::lock_guard lock(trail_mutex_);
      trail_.add(from_lcm(m));
    });
  }
  auto found = waiting_.find(channel);
  if (found == waiting_.end()) {
    if (waiting_.size() >= most_channels) return;
    found = waiting_.emplace(channel, Waiting{}).first;
  }
  found->second.data.assign(data.begin(), data.end());
  found->second.fresh = true;
}

void Relay::pass_on_runs(Duration now) {
  const std::vector<vehicle::Run> runs = runs_.present(now);
  std::erase_if(players_, [&](const auto& player) {
    return std::none_of(runs.begin(), runs.end(),
                        [&](const vehicle::Run& run) { return run.id == player.first; });
  });
  nlohmann::json all = nlohmann::json::array();
  for (const vehicle::Run& run : runs) {
    nlohmann::json player;
    const auto found = players_.find(run.id);
    schema::DecodedMessage message;
    if (found != players_.end() &&
        !message.decode(*schema_.find(schema::fingerprint_of(found->second)), found->second)) {
      player = nlohmann::json::parse(to_json(message));
    }
    all.push_back({{"id", run.id}, {"what", run.what}, {"player", std::move(player)}});
  }
  std::string text = text_of(all);
  if (text == said_runs_) return;
  channels_.put("RUNS", text);
  said_runs_ = std::move(text);
}

void Relay::pass_on(Duration now) {
  pass_on_runs(now);
  schema::DecodedMessage message;
  for (auto& [channel, waiting] : waiting_) {
    if (!std::exchange(waiting.fresh, false)) continue;
    const schema::Type* type = schema_.find(schema::fingerprint_of(waiting.data));
    if (type == nullptr || message.decode(*type, waiting.data)) {
      ++not_understood_;
      continue;
    }
    channels_.put(channel, to_json(message));
  }
}

std::string Relay::trail() const {
  const std::lock_guard lock(trail_mutex_);
  return trail_.json();
}

std::vector<std::uint8_t> encoded_command(const std::string& run, const std::string& kind,
                                          double value) {
  constexpr std::array<std::pair<const char*, std::int8_t>, 8> kinds{{
      {"pause", Control::PAUSE},
      {"resume", Control::RESUME},
      {"step-sample", Control::STEP_SAMPLE},
      {"step-image", Control::STEP_IMAGE},
      {"seek", Control::SEEK},
      {"speed", Control::SPEED},
      {"next-miss", Control::NEXT_MISS},
      {"quit", Control::QUIT},
  }};
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return kind == k.first; });
  if (found == kinds.end()) return {};
  Control command{};
  command.kind = found->second;
  command.run = run;
  command.value = value;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(command.getEncodedSize()));
  command.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace maploop::dashboard
