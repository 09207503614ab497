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

constexpr std::size_t most_channels = 64, most_sources = 64;
constexpr std::size_t longest_verdict = 400;
constexpr Duration announced_within = std::chrono::milliseconds(1500);  // runs do it once a second
constexpr Duration forgotten_after = std::chrono::seconds(10);
constexpr const char* others = "others";  // the run of programs that announce none

}  // namespace

// A message of another publisher may have the correct form but invalid values.
template <class Message>
void Relay::add_to_trail(Source& source, std::span<const std::uint8_t> data) {
  Message message;
  if (!schema::checked_decode(schema::own_schema(), data, message)) return;
  try {
    source.trail.add(from_lcm(message));
  } catch (const std::invalid_argument&) {
  }
}

Relay::Source* Relay::source_of(std::string_view sender, Duration now) {
  auto found = sources_.find(sender);
  if (found == sources_.end()) {
    if (sources_.size() >= most_sources) return nullptr;
    found = sources_.try_emplace(std::string(sender), Source{now, now, ""}).first;
  }
  found->second.heard = now;
  return &found->second;
}

// The messages of two runs of one source cannot be told apart: they are those of the first.
void Relay::take_run(Source& source, std::span<const std::uint8_t> data, Duration now) {
  maploop_lcm::run_t run;
  if (!schema::checked_decode(schema::own_schema(), data, run)) return;
  runs_.take(run, now);
  update_runs(now);
  const auto shown = shown_.find(run.id);
  if (shown == shown_.end()) return;
  const auto own = shown_.find(source.run);
  if (own == shown_.end() || own->second.ended || source.run == others) {
    if (!source.run.empty() && source.run != run.id) source.trail = Trail();
    source.run = run.id;
  }
  if (run.ended == 0) return;
  channels_.put(
      run.id, "VERDICT",
      json_text(
          {{"id", run.id}, {"what", run.what}, {"lines", run.verdict.substr(0, longest_verdict)}}));
}

void Relay::take_player(std::span<const std::uint8_t> data, Duration now) {
  Control state;
  if (!schema::checked_decode(schema::own_schema(), data, state)) return;
  const std::lock_guard lock(sources_mutex_);
  update_runs(now);
  const auto run = shown_.find(state.run);
  if (state.kind == Control::STATE && run != shown_.end() && !run->second.ended) {
    players_[state.run] = lcm_log::to_json(*try_decode(schema::own_schema(), data));
  }
}

void Relay::take(std::string_view sender, std::string_view channel,
                 std::span<const std::uint8_t> data, Duration now) {
  if (channel == channel_names::camera || channel == channel_names::velodyne) return;
  if (channel == channel_names::replay_control) return take_player(data, now);
  const std::lock_guard lock(sources_mutex_);
  Source* source = source_of(sender, now);
  if (source == nullptr) return;
  if (channel == channel_names::run) return take_run(*source, data, now);
  if (channel == channel_names::nav_state) add_to_trail<maploop_lcm::nav_state_t>(*source, data);
  if (channel == channel_names::truth) add_to_trail<maploop_lcm::reference_pose_t>(*source, data);
  const std::string name(channel);
  if (source->waiting.size() >= most_channels && !source->waiting.contains(name)) return;
  source->waiting[name].assign(data.begin(), data.end());
}

// A run takes the place of those that have ended.
void Relay::begin(const std::string& id, const std::string& what) {
  std::erase_if(shown_, [&](const auto& old) {
    if (old.second.ended) channels_.forget(old.first);
    return old.second.ended;
  });
  shown_[id].what = what;
}

void Relay::update_runs(Duration now) {
  const std::vector<vehicle::Run> present = runs_.present(now);
  const auto is_present = [&](const std::string& id) {
    return std::any_of(present.begin(), present.end(),
                       [&](const vehicle::Run& run) { return run.id == id; });
  };
  const bool others_send = std::any_of(sources_.begin(), sources_.end(), [](const auto& source) {
    return source.second.run == others;
  });
  for (auto& [id, run] : shown_) {
    run.ended = id == others ? !others_send : !is_present(id);
    if (run.ended) players_.erase(id);
  }
  if (others_send && !shown_.contains(others)) begin(others, "programs that announce no run");
  for (const vehicle::Run& run : present) {
    if (!shown_.contains(run.id)) begin(run.id, run.what);
  }
}

void Relay::pass_on_runs(Duration now) {
  update_runs(now);
  nlohmann::json all = nlohmann::json::array();
  for (const auto& [id, run] : shown_) {
    const auto player = players_.find(id);
    all.push_back({{"id", id},
                   {"what", run.what},
                   {"ended", run.ended},
                   {"player", player == players_.end() ? nlohmann::json()
                                                       : nlohmann::json::parse(player->second)}});
  }
  std::string text = json_text(all);
  if (text == said_runs_) return;
  channels_.put(LiveChannels::all_runs, "RUNS", text);
  said_runs_ = std::move(text);
}

void Relay::pass_on(Source& source) {
  for (auto& [channel, data] : source.waiting) {
    if (data.empty()) continue;
    if (const auto message = try_decode(schema::own_schema(), data)) {
      if (source.run.empty()) source.run = others;
      channels_.put(source.run, channel, lcm_log::to_json(*message));
    } else {
      ++not_understood_;
    }
    data.clear();
  }
}

void Relay::pass_on(Duration now) {
  const std::lock_guard lock(sources_mutex_);
  std::erase_if(sources_, [&](const auto& entry) {
    const auto& [sender, source] = entry;
    const bool is_shown = source.run != others && shown_.contains(source.run);
    return !is_shown && now - source.heard > forgotten_after;
  });
  for (auto& [sender, source] : sources_) {
    const bool is_new = source.run.empty() && now - source.since < announced_within;
    const bool is_known = source.run.empty() || source.run == others || shown_.contains(source.run);
    if (!is_new && is_known) pass_on(source);
  }
  pass_on_runs(now);
}

std::string Relay::trail(const std::string& run) const {
  const std::lock_guard lock(sources_mutex_);
  const auto found = std::find_if(sources_.begin(), sources_.end(),
                                  [&](const auto& source) { return source.second.run == run; });
  return (found == sources_.end() ? Trail() : found->second.trail).json();
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
