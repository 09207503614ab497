// maploop spy: what comes on an LCM bus, or lies in a log, channel by channel.
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/command/bus_listener.h"
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/terminal.h"
#include "tools/log/log_files.h"
#include "tools/spy/screen.h"
#include "tools/spy/text.h"

namespace maploop::tools {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::filesystem::path;

constexpr int exit_nothing_heard = 1;
constexpr double once_listens = 3.0;  // s: long enough for what comes once a second
constexpr Duration live_window = seconds(5);
constexpr Duration log_window = Duration::max();

struct SpyOptions {
  std::vector<path> logs, types;
  std::string lcm_url;
  std::string filter;
  bool plain = false, once = false, json = false;
  double seconds = 0.0;  // 0: until it is ended
};

Duration steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

// Where the messages come from, and the clock that they arrive by.
struct Feed {
  std::string name;
  std::function<void(int milliseconds)> wait;  // takes what comes meanwhile
  std::function<Duration()> now;
};

// Returns the latest time of the log, not before `latest`.
Duration read_log(const path& file, Duration latest, spy::Traffic& traffic) {
  const auto read = lcm_log::read_log(file, traffic.schema(), [&](const lcm_log::LogEvent& event) {
    const auto time = std::chrono::microseconds(event.time_us);
    if (time > Duration(0) && time < std::chrono::years(230)) {
      latest = std::max(latest, Duration(time));
    }
    traffic.add(event.channel, event.data, latest);
  });
  if (read.damages > 0) {
    std::cerr << "maploop: " << file.string() << " is damaged in " << read.damages
              << " places; 'maploop log verify' names them\n";
  }
  return latest;
}

// The terminal's other screen, without a cursor, as long as it lives.
class OtherScreen {
 public:
  OtherScreen() { std::cout << "\x1b[?1049h\x1b[?25l" << std::flush; }
  ~OtherScreen() { std::cout << "\x1b[?25h\x1b[?1049l" << std::flush; }
  OtherScreen(const OtherScreen&) = delete;
  OtherScreen& operator=(const OtherScreen&) = delete;
};

void show(const Feed& feed, const spy::Traffic& traffic, spy::Screen& screen,
          const std::function<bool()>& over) {
  constexpr int wait = 50;  // ms
  constexpr int show_every = 4;
  const Keyboard keyboard;
  const OtherScreen other;
  for (int i = 0; !screen.quit() && !over(); ++i) {
    bool pressed = false;
    while (const auto key = keyboard.pressed()) {
      screen.press(*key);
      pressed = true;
    }
    if (pressed || i % show_every == 0) {
      winsize size{};
      ioctl(STDOUT_FILENO, TIOCGWINSZ, &size);
      const std::size_t rows = size.ws_row > 0 ? size.ws_row : 24;
      const std::size_t columns = size.ws_col > 0 ? size.ws_col : 80;
      std::cout << screen.picture(traffic, feed.now(), rows, columns) << std::flush;
    }
    feed.wait(wait);
  }
}

void print(const SpyOptions& options, const spy::Traffic& traffic, Duration now,
           const lcm_log::ChannelFilter& filter) {
  const auto channels = traffic.status(now, filter);
  if (options.json) {
    for (const spy::ChannelStatus& s : channels) std::cout << spy::json_row(s) << '\n';
  } else {
    std::cout << spy::table_header() << '\n';
    for (const spy::ChannelStatus& s : channels) std::cout << spy::table_row(s) << '\n';
    for (const std::string& line : spy::vehicle_lines(traffic)) {
      std::cout << "# " << line << '\n';
    }
  }
  std::cout << std::flush;
}

void print_every_second(const SpyOptions& options, const Feed& feed, const spy::Traffic& traffic,
                        const lcm_log::ChannelFilter& filter, const std::function<bool()>& over) {
  const bool once = options.once || !options.logs.empty();
  Duration next = steady_now() + seconds(1);
  while (!over()) {
    feed.wait(20);
    if (once || steady_now() < next) continue;
    print(options, traffic, feed.now(), filter);
    next += seconds(1);
  }
  if (once) print(options, traffic, feed.now(), filter);
}

int run(const SpyOptions& options) {
  const lcm_log::ChannelFilter filter = spy::filter_of(options.filter);
  const schema::Schema schema = lcm_log::load_types(options.types);
  const bool of_logs = !options.logs.empty();
  spy::Traffic traffic(schema, of_logs ? log_window : live_window);
  const bool plain = options.plain || options.once || options.json || !is_screen(STDOUT_FILENO);

  Feed feed;
  std::optional<BusListener> bus;
  if (of_logs) {
    Duration end{};
    for (const path& log : options.logs) end = read_log(log, end, traffic);
    feed.name = options.logs.front().string();
    feed.wait = [](int ms) { usleep(static_cast<useconds_t>(ms) * 1000); };
    feed.now = [end] { return end; };
  } else {
    feed.name = vehicle::bus_url(options.lcm_url);
    bus.emplace(feed.name, ".*",
                [&](auto channel, auto data) { traffic.add(channel, data, steady_now()); });
    feed.wait = [&](int ms) { bus->listen(ms); };
    feed.now = steady_now;
  }

  const double length = options.once && options.seconds == 0.0 ? once_listens : options.seconds;
  const Duration end = steady_now() + from_seconds(length);
  const auto over = [&] {
    return interrupted() || (of_logs && plain) || (length > 0.0 && steady_now() >= end);
  };
  note_interrupts();
  if (plain) {
    print_every_second(options, feed, traffic, filter, over);
  } else {
    spy::Screen screen(feed.name, options.filter);
    show(feed, traffic, screen, over);
  }
  if (traffic.count() > 0 || !plain) return 0;
  std::cerr << "maploop: nothing was heard " << (of_logs ? "in '" : "at '") << feed.name
            << (of_logs ? "': the log has no message\n"
                        : "': is anybody publishing there, on this host and with this URL?\n");
  return exit_nothing_heard;
}

}  // namespace

void add_spy(CLI::App& app, Command& command) {
  auto options = std::make_shared<SpyOptions>();
  CLI::App* sub = app.add_subcommand(
      "spy", "Watch the channels of an LCM bus or of logs: rates, ages, losses, decoded fields");
  auto* logs = sub->add_option("LOG", options->logs, "LCM logs, plain or .gz, instead of the bus");
  add_lcm_url(sub, options->lcm_url)->excludes(logs);
  sub->add_option("--filter", options->filter,
                  "Only channels whose name this regular expression matches anywhere");
  sub->add_option("--types", options->types,
                  "Files (.lcm) of message types besides the program's own");
  sub->add_flag("--plain", options->plain,
                "A table each second instead of a screen; so it is, too, where the output is no "
                "terminal");
  sub->add_flag("--once", options->once, "One table, after listening for 3 s (or for --seconds)");
  sub->add_option("--seconds", options->seconds, "Listen this long")->check(positive_number());
  sub->add_flag("--json", options->json, "As --plain, one JSON object a channel and line");
  sub->callback([options, &command] { command = [options] { return run(*options); }; });
}

}  // namespace maploop::tools
