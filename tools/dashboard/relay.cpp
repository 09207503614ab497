#include "tools/dashboard/relay.h"

#include <algorithm>
#include <array>
#include <maploop_lcm/replay_control_t.hpp>
#include <maploop_lcm/run_t.hpp>
#include <stdexcept>
#include <utility>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "msgs/lcm/decoded_message.h"
#include "tools/dashboard/json_text.h"
#include "tools/log/message_json.h"

namespace maploop::dashboard {
namespace {

using Control = maploop_lcm::replay_control_t;

constexpr std::size_t most_channels = 64;
constexpr std::size_t longest_verdict = 400;

auto with_id(const std::string& id) {
  return [&id](const vehicle::Run& run) { return run.id == id; };
}

}  // namespace

// A message of another publisher may have the correct form but invalid values.
template <class Message>
void Relay::add_to_trail(std::span<const std::uint8_t> data) {
  Message message;
  if (!schema::checked_decode(schema::own_schema(), data, message)) return;
  try {
    const std::lock_guard lock(trail_mutex_);
    trail_.add(from_lcm(message));
  } catch (const std::invalid_argument&) {
  }
}

void Relay::take_run(std::span<const std::uint8_t> data, Duration now) {
  maploop_lcm::run_t run;
  if (!schema::checked_decode(schema::own_schema(), data, run)) return;
  runs_.take(run, now);
  if (run.ended == 0 || run.verdict.empty()) return;
  channels_.put("VERDICT", json_text({{"id", run.id},
                                      {"what", run.what},
                                      {"lines", run.verdict.substr(0, longest_verdict)}}));
}

void Relay::take_player(std::span<const std::uint8_t> data, Duration now) {
  Control state;
  if (!schema::checked_decode(schema::own_schema(), data, state)) return;
  const std::vector<vehicle::Run> runs = runs_.present(now);
  if (state.kind == Control::STATE && std::any_of(runs.begin(), runs.end(), with_id(state.run))) {
    players_[state.run] = lcm_log::to_json(*try_decode(schema::own_schema(), data));
  }
}

void Relay::take(std::string_view channel, std::span<const std::uint8_t> data, Duration now) {
  if (channel == channel_names::camera || channel == channel_names::velodyne) return;
  if (channel == channel_names::run) return take_run(data, now);
  if (channel == channel_names::replay_control) return take_player(data, now);
  if (channel == channel_names::nav_state) add_to_trail<maploop_lcm::nav_state_t>(data);
  if (channel == channel_names::truth) add_to_trail<maploop_lcm::reference_pose_t>(data);
  auto found = waiting_.find(channel);
  if (found == waiting_.end()) {
    if (waiting_.size() >= most_channels) return;
    found = waiting_.try_emplace(std::string(channel)).first;
  }
  found->second.assign(data.begin(), data.end());
}

void Relay::pass_on_runs(Duration now) {
  const std::vector<vehicle::Run> runs = runs_.present(now);
  std::erase_if(players_, [&](const auto& player) {
    return std::none_of(runs.begin(), runs.end(), with_id(player.first));
  });
  nlohmann::json all = nlohmann::json::array();
  for (const vehicle::Run& run : runs) {
    const auto player = players_.find(run.id);
    all.push_back({{"id", run.id},
                   {"what", run.what},
                   {"player", player == players_.end() ? nlohmann::json()
                                                       : nlohmann::json::parse(player->second)}});
  }
  std::string text = json_text(all);
  if (text == said_runs_) return;
  channels_.put("RUNS", text);
  said_runs_ = std::move(text);
}

void Relay::pass_on(Duration now) {
  pass_on_runs(now);
  for (auto& [channel, data] : waiting_) {
    if (data.empty()) continue;
    if (const auto message = try_decode(schema::own_schema(), data)) {
      channels_.put(channel, lcm_log::to_json(*message));
    } else {
      ++not_understood_;
    }
    data.clear();
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
  return schema::encoded(command);
}

}  // namespace maploop::dashboard
