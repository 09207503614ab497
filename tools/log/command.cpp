// maploop log: what LCM logs hold, whether they are sound, and how they differ.
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msgs/lcm/channel_names.h"
#include "runtime/vehicle/output/black_box.h"
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/log/log_tools.h"

namespace maploop::tools {
namespace {

using std::filesystem::path;

constexpr int exit_found = 1;   // findings, differences, damage in what was read
constexpr int exit_failed = 2;  // of verify and diff, where 1 is an answer

struct LogOptions {
  path log, other;
  std::vector<path> logs;
  std::vector<path> types;
  path output, json;
  std::optional<double> start, end;
  std::optional<std::string> channels, every;
  std::string compression = "lz4";
  bool freeze = false;

  schema::Schema schema() const { return lcm_log::load_types(types); }
};

// Reports damage on stderr and returns the exit status. The undamaged rest has been written.
int report_damage(const lcm_log::LogSummary& read) {
  if (read.damages == 0) return 0;
  std::cerr << "maploop: " << lcm_log::size_text(read.damaged_bytes) << " in " << read.damages
            << " places are damaged and were left out; 'maploop log recover' accounts for them\n";
  return exit_found;
}

int info(const LogOptions& o) {
  lcm_log::info(o.log, o.schema(), o.json, std::cout);
  return 0;
}

int verify(const LogOptions& o) {
  return lcm_log::verify(o.log, o.schema(), std::cout).findings == 0 ? 0 : exit_found;
}

int split(const LogOptions& o) {
  lcm_log::SplitParameters parameters{.start_s = o.start, .end_s = o.end, .output = o.output};
  if (o.channels) parameters.channels = lcm_log::matching(*o.channels);
  if (o.every) parameters.every = lcm_log::parse_piece_limit(*o.every);
  return report_damage(lcm_log::split(o.log, o.schema(), parameters, std::cout));
}

int merge(const LogOptions& o) {
  return report_damage(lcm_log::merge(o.logs, o.schema(), o.output, std::cout));
}

int convert(const LogOptions& o) {
  return report_damage(lcm_log::convert(o.log, o.schema(), o.output, o.compression, std::cout));
}

int recover(const LogOptions& o) {
  lcm_log::recover(o.log, o.schema(), o.output, std::cout);
  return 0;
}

int black_box(const LogOptions& o) {
  if (o.freeze) {
    vehicle::ask_to_freeze(o.log);
    std::cout << o.log.string() << ": its run writes it for ten seconds more\n";
    return 0;
  }
  if (o.output.empty()) throw std::invalid_argument("either --output or --freeze is needed");
  lcm_log::black_box(o.log, o.schema(), o.output, std::cout);
  return 0;
}

int diff(const LogOptions& o) {
  lcm_log::ChannelFilter filter = [](std::string_view channel) {
    return channel != channel_names::deadlines && channel != channel_names::health;
  };
  if (o.channels) filter = lcm_log::matching(*o.channels);
  return lcm_log::diff(o.log, o.other, o.schema(), filter, std::cout) ? 0 : exit_found;
}

// Runs a command whose status 1 is an answer, so that a failure has another one.
template <int (*run)(const LogOptions&)>
int or_failed(const LogOptions& o) {
  try {
    return run(o);
  } catch (const std::exception& e) {
    std::cerr << "maploop: " << e.what() << '\n';
    return exit_failed;
  }
}

}  // namespace

void add_log(CLI::App& app, Command& command) {
  auto options = std::make_shared<LogOptions>();
  CLI::App* log =
      app.add_subcommand("log", "Look into, check, cut, join, convert, rescue and compare logs");
  log->require_subcommand(1);
  CLI::App* sub = nullptr;
  const auto add = [&](const char* name, const char* what, int (*run)(const LogOptions&)) {
    sub = log->add_subcommand(name, what);
    sub->add_option("--types", options->types,
                    "Files (.lcm) of message types besides the program's own");
    sub->callback([options, run, &command] { command = [options, run] { return run(*options); }; });
  };
  const auto add_log = [&](const char* name, path& file) {
    sub->add_option(name, file, "LCM log, plain or .gz")->required();
  };
  const auto add_output = [&](const char* what) {
    sub->add_option("-o,--output", options->output, what)->required()->check(writable_file());
  };
  const auto add_number = [&](const char* name, std::optional<double>& to, const char* what) {
    sub->add_option(name, to, what)->check(finite_number());
  };

  add("info", "Channels, types, rates, jitter and gaps of a log", info);
  add_log("LOG", options->log);
  sub->add_option("--json", options->json, "Write the same to this file as JSON")
      ->check(writable_file());

  add("verify", "Check structure, event numbers, times and messages; status 1: findings",
      or_failed<verify>);
  add_log("LOG", options->log);

  add("split", "Write a part of a log, or a log in pieces", split);
  add_log("LOG", options->log);
  add_number("--start", options->start, "Seconds since the log's first event");
  add_number("--end", options->end, "Seconds since the log's first event, itself left out");
  sub->add_option("--channels", options->channels, "Regular expression of whole channel names");
  sub->add_option("--every", options->every,
                  "Length of a piece, such as 60s, 5min, 1h or 500kB, 100MB, 2GB");
  add_output("Log to write (.gz: compressed); pieces get numbers in their names");

  add("merge", "Join logs to one, by time", merge);
  sub->add_option("LOGS", options->logs, "LCM logs, plain or .gz")->required();
  add_output("Log to write (.gz: compressed)");

  add("convert", "Write a log as an MCAP file for Foxglove or PlotJuggler, or as a bag of ROS 1",
      convert);
  add_log("LOG", options->log);
  add_output("File to write: .mcap, .bag, or a log");
  sub->add_option("--compression", options->compression, "Of a bag: none, lz4 or bz2")
      ->check(CLI::IsMember({"none", "lz4", "bz2"}))
      ->capture_default_str();

  add("recover", "Write everything readable of a damaged log", recover);
  add_log("LOG", options->log);
  add_output("Log to write (.gz: compressed)");

  add("blackbox",
      "Write what a run's black box (--black-box) holds as a log, with the snapshot from which it "
      "is replayed; or ask the run to freeze it",
      black_box);
  sub->add_option("BOX", options->log, "Black box, also of a run that goes on")
      ->required()
      ->check(existing_file());
  auto* box_log = sub->add_option("-o,--output", options->output,
                                  "Log to write; the snapshot has the same name with .snapshot")
                      ->check(writable_file());
  sub->add_flag("--freeze", options->freeze,
                "Let the run write it for ten seconds more, and then no longer")
      ->excludes(box_log);

  add("diff", "Compare the messages of two logs; status 1: different, 2: cannot be compared",
      or_failed<diff>);
  add_log("A", options->log);
  add_log("B", options->other);
  sub->add_option("--channels", options->channels,
                  "Regular expression of whole channel names; without it all but DEADLINES "
                  "and HEALTH, whose moments are the run's and not the data's");
}

}  // namespace maploop::tools
