// maploop log: what LCM logs hold, whether they are sound, and how they differ.
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/vehicle/graph/graph.h"
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/log/log_diff.h"
#include "tools/log/log_info.h"
#include "tools/log/log_merge.h"
#include "tools/log/log_recover.h"
#include "tools/log/log_split.h"
#include "tools/log/log_text.h"
#include "tools/log/log_types.h"
#include "tools/log/log_verify.h"

namespace maploop::tools {
namespace {

using std::filesystem::path;

constexpr int kExitFound = 1;   // findings, differences, damage in what was read
constexpr int kExitFailed = 2;  // of verify and diff, where 1 is an answer

struct LogOptions {
  path log, other;
  std::vector<path> logs;
  std::vector<path> types;
  path output, json;
  std::optional<double> start, end;
  std::optional<std::string> channels, every;
};

// What was read but for its damage is written all the same; the status tells.
int report_damage(std::uint64_t damages, std::uint64_t bytes) {
  if (damages == 0) return 0;
  std::cerr << "maploop: " << lcm_log::size_text(bytes) << " in " << damages
            << " places are damaged and were left out; 'maploop log recover' accounts for them\n";
  return kExitFound;
}

int info(const LogOptions& options) {
  const auto schema = lcm_log::load_types(options.types);
  const lcm_log::LogInfo result = lcm_log::read_info(options.log, schema);
  std::cout << lcm_log::format_table(result);
  if (!options.json.empty()) lcm_log::write_json(options.json, result);
  return 0;
}

int verify(const LogOptions& options) {
  const auto schema = lcm_log::load_types(options.types);
  const lcm_log::Verification result = lcm_log::verify(options.log, schema);
  std::cout << lcm_log::format_findings(result);
  return result.finding_count == 0 ? 0 : kExitFound;
}

int split(const LogOptions& options) {
  lcm_log::SplitParameters parameters;
  parameters.start_s = options.start;
  parameters.end_s = options.end;
  if (options.channels) parameters.channels = lcm_log::ChannelFilter(*options.channels);
  if (options.every) parameters.every = lcm_log::parse_piece_limit(*options.every);
  parameters.output = options.output;
  const auto result =
      lcm_log::split(options.log, lcm_log::load_types(options.types), std::move(parameters));
  std::cout << result.events_taken << " of " << result.events_read << " events written to "
            << result.files.front().string();
  if (result.files.size() > 1) {
    std::cout << " and " << result.files.size() - 1 << " more, up to "
              << result.files.back().string();
  }
  std::cout << '\n';
  return report_damage(result.damages, result.damaged_bytes);
}

int merge(const LogOptions& options) {
  const auto result =
      lcm_log::merge(options.logs, lcm_log::load_types(options.types), options.output);
  std::cout << result.events << " events of " << options.logs.size() << " logs written to "
            << options.output.string() << '\n';
  return report_damage(result.damages, result.damaged_bytes);
}

int recover(const LogOptions& options) {
  const auto result =
      lcm_log::recover(options.log, lcm_log::load_types(options.types), options.output);
  std::cout << lcm_log::format_report(result);
  return 0;
}

int diff(const LogOptions& options) {
  using namespace vehicle;
  lcm_log::ChannelFilter filter(
      {std::string(channels::deadlines.name), std::string(channels::health.name)});
  if (options.channels) filter = lcm_log::ChannelFilter(*options.channels);
  const auto result = lcm_log::diff(options.log, options.other, lcm_log::load_types(options.types),
                                    std::move(filter));
  if (result.channels.empty()) {
    throw std::runtime_error("neither log has a message on these channels: nothing was compared");
  }
  std::cout << lcm_log::format_diff(result, options.log.string(), options.other.string());
  return result.same() ? 0 : kExitFound;
}

// For commands whose status 1 is an answer.
int or_failed(int (*run)(const LogOptions&), const LogOptions& options) {
  try {
    return run(options);
  } catch (const std::exception& e) {
    std::cerr << "maploop: " << e.what() << '\n';
    return kExitFailed;
  }
}

using Options = std::shared_ptr<LogOptions>;

CLI::App* add(CLI::App& log, const Options& options, const char* name, const char* what) {
  CLI::App* sub = log.add_subcommand(name, what);
  sub->add_option("--types", options->types,
                  "Files (.lcm) of message types besides the program's own");
  return sub;
}

void add_log_argument(CLI::App* sub, const Options& options) {
  sub->add_option("LOG", options->log, "LCM log, plain or .gz")->required();
}

void add_output(CLI::App* sub, const Options& options, const char* what) {
  sub->add_option("-o,--output", options->output, what)->required()->check(writable_file());
}

}  // namespace

void add_log(CLI::App& app, Command& command) {
  auto options = std::make_shared<LogOptions>();
  CLI::App* log = app.add_subcommand("log", "Look into, check, cut, join, rescue and compare logs");
  log->require_subcommand(1);

  CLI::App* sub = add(*log, options, "info", "Channels, types, rates, jitter and gaps of a log");
  add_log_argument(sub, options);
  sub->add_option("--json", options->json, "Write the same to this file as JSON")
      ->check(writable_file());
  sub->callback([options, &command] { command = [options] { return info(*options); }; });

  sub = add(*log, options, "verify",
            "Check structure, event numbers, times and messages; status 1: findings");
  add_log_argument(sub, options);
  sub->callback(
      [options, &command] { command = [options] { return or_failed(verify, *options); }; });

  sub = add(*log, options, "split", "Write a part of a log, or a log in pieces");
  add_log_argument(sub, options);
  sub->add_option("--start", options->start, "Seconds since the log's first event")
      ->check(finite_number());
  sub->add_option("--end", options->end, "Seconds since the log's first event, itself left out")
      ->check(finite_number());
  sub->add_option("--channels", options->channels, "Regular expression of whole channel names");
  sub->add_option("--every", options->every,
                  "Length of a piece, such as 60s, 5min, 1h or 500kB, 100MB, 2GB");
  add_output(sub, options, "Log to write (.gz: compressed); pieces get numbers in their names");
  sub->callback([options, &command] { command = [options] { return split(*options); }; });

  sub = add(*log, options, "merge", "Join logs to one, by time");
  sub->add_option("LOGS", options->logs, "LCM logs, plain or .gz")->required();
  add_output(sub, options, "Log to write (.gz: compressed)");
  sub->callback([options, &command] { command = [options] { return merge(*options); }; });

  sub = add(*log, options, "recover", "Write everything readable of a damaged log");
  add_log_argument(sub, options);
  add_output(sub, options, "Log to write (.gz: compressed)");
  sub->callback([options, &command] { command = [options] { return recover(*options); }; });

  sub = add(*log, options, "diff",
            "Compare the messages of two logs; status 1: different, 2: cannot be compared");
  sub->add_option("A", options->log, "LCM log, plain or .gz")->required();
  sub->add_option("B", options->other, "LCM log, plain or .gz")->required();
  sub->add_option("--channels", options->channels,
                  "Regular expression of whole channel names; without it all but DEADLINES and "
                  "HEALTH, which speak of the run and not of the data");
  sub->callback([options, &command] { command = [options] { return or_failed(diff, *options); }; });
}

}  // namespace maploop::tools
