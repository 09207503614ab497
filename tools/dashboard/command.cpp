// maploop dashboard: a running vehicle in a browser.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapmatch/map_area.h"
#include "msgs/lcm/channel_names.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tools/command/bus_listener.h"
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/terminal.h"
#include "tools/dashboard/foxglove_bridge.h"
#include "tools/dashboard/foxglove_server.h"
#include "tools/dashboard/live_channels.h"
#include "tools/dashboard/relay.h"
#include "tools/dashboard/sender_listener.h"
#include "tools/dashboard/server.h"
#include "tools/match/road_lines.h"
#include "tools/web/bundle.h"
#include "tools/web/page.h"

namespace maploop::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds pass_on_every{100};
constexpr int listen_ms = 20;

Duration now() {
  return Clock::now().time_since_epoch();
}

std::int64_t wall_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

struct DashboardOptions {
  std::string lcm_url;
  std::string address = "127.0.0.1";
  int port = 8080;
  std::optional<int> foxglove;
  std::vector<std::string> origins;
  double seconds = 0.0;  // 0: until interrupted
  std::filesystem::path map;
};

constexpr double roads_within = 5000.0;  // m of a drive's origin

// Roads in metres about the origin; none where there is no map.
std::string roads_about(const vehicle::RoadMap* map, const Geodetic& origin) {
  web::Plot plot;
  if (map != nullptr) {
    const auto roads = network_about(*map, std::span(&origin, 1), roads_within);
    plot.roads = match::road_lines(*roads, origin, {{"", {0.0}, {0.0}}}, roads_within);
  }
  return web::to_json(plot);
}

std::string send_command(BusListener& bus, const std::string& run, const std::string& kind,
                         double value) {
  const auto command = dashboard::encoded_command(run, kind, value);
  if (command.empty()) return "there is no command '" + kind + "'";
  const std::string channel(channel_names::replay_control);
  return bus.publish(channel, command) ? "" : "LCM did not take the command";
}

void say_losses(std::uint64_t by_viewers, std::uint64_t not_understood) {
  if (by_viewers > 0) {
    std::cerr << "maploop: viewers of Foxglove were too slow for " << by_viewers << " messages\n";
  }
  if (not_understood > 0) {
    std::cerr << "maploop: " << not_understood
              << " messages were of no type that this version knows, or damaged\n";
  }
}

int run(const DashboardOptions& options) {
  if (web::dashboard_script().empty()) {
    throw std::runtime_error(
        "this maploop was built without npm, which makes the dashboard's page: install npm "
        "(tools/install-packages web) and build again");
  }
  vehicle::MapParameters map_options;
  map_options.file = options.map;
  const auto map = vehicle::load_road_map(map_options);
  dashboard::LiveChannels channels;
  dashboard::Relay relay(channels);
  std::optional<dashboard::FoxgloveBridge> foxglove;
  const std::string url = vehicle::bus_url(options.lcm_url);
  const bool knows_senders = dashboard::SenderListener::understands(url);
  const bool hears_all = !knows_senders || options.foxglove;
  BusListener bus(url, hears_all ? ".*" : "none", [&](auto channel, auto data) {
    if (!knows_senders) relay.take("", channel, data, now());
    if (foxglove) foxglove->take({.time_us = wall_us(), .channel = channel, .data = data});
  });
  std::optional<dashboard::SenderListener> senders;
  if (knows_senders) {
    senders.emplace(url, [&](auto sender, auto channel, auto data) {
      relay.take(sender, channel, data, now());
    });
  }
  const auto control = [&](const std::string& run, const std::string& kind, double value) {
    return send_command(bus, run, kind, value);
  };
  std::optional<dashboard::FoxgloveServer> viewers;
  if (options.foxglove) {
    viewers.emplace(options.address, *options.foxglove, options.origins, control);
    foxglove.emplace(*viewers);
  }
  const dashboard::Server server(
      options.address, options.port, channels,
      {[&](const std::string& id) { return relay.trail(id); }, control,
       [&](const Geodetic& origin) { return roads_about(map.get(), origin); }});
  note_interrupts();
  std::cout << "http://" << options.address << ':' << server.port() << "/  (Ctrl-C ends it)"
            << std::endl;
  if (viewers) {
    std::cout << "ws://" << options.address << ':' << viewers->port() << "  for Foxglove"
              << std::endl;
  }
  const auto end = Clock::now() + from_seconds(options.seconds);
  auto next = Clock::now();
  while (!interrupted() && (options.seconds == 0.0 || Clock::now() < end)) {
    if (senders) senders->listen(listen_ms);
    bus.listen(senders ? 0 : listen_ms);
    if (Clock::now() < next) continue;
    relay.pass_on(now());
    next = Clock::now() + pass_on_every;
  }
  say_losses(viewers ? viewers->lost() : 0, relay.not_understood());
  return 0;
}

}  // namespace

void add_dashboard(CLI::App& app, Command& command) {
  auto options = std::make_shared<DashboardOptions>();
  CLI::App* sub = app.add_subcommand("dashboard",
                                     "Show a running replay or vehicle in a browser: way, camera, "
                                     "scan, satellites, state, deadlines");
  add_lcm_url(sub, options->lcm_url);
  sub->add_option("--address", options->address,
                  "Address to listen at; other than this machine's own (127.0.0.1) lets others "
                  "look, and control a replay")
      ->capture_default_str();
  sub->add_option("--port", options->port, "Port to listen at, 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  auto* foxglove = sub->add_option("--foxglove", options->foxglove,
                                   "Serve Foxglove as well, at this port (8765 is its own), 0: any "
                                   "that is free")
                       ->check(CLI::Range(0, 65535));
  sub->add_option("--origin", options->origins,
                  "Let a web page of this origin connect to --foxglove, such as "
                  "https://app.foxglove.dev")
      ->needs(foxglove)
      ->allow_extra_args(false);
  sub->add_option("--map", options->map,
                  "OpenStreetMap file, network file or tiled map: draw its roads under the way")
      ->check(existing_file());
  sub->add_option("--seconds", options->seconds, "End after this long; without it at Ctrl-C")
      ->check(positive_number());
  sub->callback([options, &command] { command = [options] { return run(*options); }; });
}

}  // namespace maploop::tools
