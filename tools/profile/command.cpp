// maploop profile: where the time of a run went, from its DEADLINES and HEALTH.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/command/bus_listener.h"
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/terminal.h"
#include "tools/evaluate/text_file.h"
#include "tools/profile/comparison.h"
#include "tools/profile/profile.h"
#include "tools/profile/trace_ticks.h"

namespace maploop::tools {
namespace {

using std::filesystem::path;

struct ProfileOptions {
  path log, other;
  bool live = false;
  std::string lcm_url;
  double seconds = 0.0;  // 0: until interrupted
  path json, html, trace;
};

void listen(const std::string& url, const ProfileOptions& options,
            profile::ProfileCollector& collector) {
  constexpr int look_every = 100;  // ms
  BusListener bus(url, "DEADLINES|HEALTH",
                  [&](auto channel, auto data) { collector.add(channel, data); });
  note_interrupts();
  const auto end = std::chrono::steady_clock::now() + from_seconds(options.seconds);
  while (!interrupted() && (options.seconds == 0.0 || std::chrono::steady_clock::now() < end)) {
    bus.listen(look_every);
  }
}

void write(const ProfileOptions& options, const std::string& text, const std::string& json,
           const std::string& html) {
  std::cout << text;
  if (!options.json.empty()) evaluation::write_text(options.json, json);
  if (!options.html.empty()) evaluation::write_text(options.html, html);
}

int run(const ProfileOptions& options) {
  if (options.live != options.log.empty()) {
    throw CLI::RequiredError("either LOG or --live");
  }
  if (!options.other.empty()) {
    const profile::Comparison both =
        profile::compare(options.log.string(), profile::profile_of_log(options.log),
                         options.other.string(), profile::profile_of_log(options.other));
    write(options, profile::to_text(both), profile::to_json(both), profile::to_html(both));
    return 0;
  }
  const nlohmann::json ticks =
      options.trace.empty() ? nlohmann::json() : profile::read_trace_ticks(options.trace);
  profile::Profile result;
  std::string name = options.log.filename().string();
  if (options.live) {
    profile::ProfileCollector collector;
    name = vehicle::bus_url(options.lcm_url);
    listen(name, options, collector);
    result = collector.profile("'" + name + "'");
  } else {
    result = profile::profile_of_log(options.log);
  }
  write(options, profile::to_text(result), profile::to_json(result),
        profile::to_html(result, name, ticks));
  return 0;
}

}  // namespace

void add_profile(CLI::App& app, Command& command) {
  const auto [sub, options] = add_command(
      app, command, "profile",
      "Latencies, misses and processor time of a run, from its DEADLINES and HEALTH", run);
  auto* log = sub->add_option("LOG", options.log, "LCM log of the run, plain or .gz");
  auto* live = sub->add_flag("--live", options.live, "Listen to a run on the bus")->excludes(log);
  add_lcm_url(sub, options.lcm_url)->needs(live);
  sub->add_option("--seconds", options.seconds, "Listen this long; without it until Ctrl-C")
      ->needs(live)
      ->check(positive_number());
  sub->add_option("--compare", options.other,
                  "LCM log of another run of the same recording, such as one on another machine "
                  "or before a change: its figures are shown beside those of LOG, with ratios")
      ->needs(log);
  add_output(sub, "--json", options.json, "Write the same to this file as JSON");
  auto* html = add_output(sub, "--html", options.html, "Write a page with pictures to this file");
  sub->add_option("--trace", options.trace,
                  "Trace of the same run (replay --trace): the page shows what each thread did in "
                  "any of its ticks")
      ->check(existing_file())
      ->needs(log)
      ->needs(html)
      ->excludes("--compare");
}

}  // namespace maploop::tools
