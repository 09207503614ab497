#include "tools/replay_console.h"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <optional>
#include <thread>

#include "runtime/vehicle/player.h"

namespace maploop::tools {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void interrupt_once() {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

// Single keys, unechoed, as long as it lives.
class Keyboard {
 public:
  Keyboard() : terminal_(isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &before_) == 0) {
    if (!terminal_) return;
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~Keyboard() {
    if (terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  bool is_terminal() const { return terminal_; }

  std::optional<char> pressed() const {
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    char key = 0;
    if (!terminal_ || poll(&ready, 1, 0) != 1 || read(STDIN_FILENO, &key, 1) != 1) return {};
    return key;
  }

 private:
  termios before_{};
  bool terminal_;
};

constexpr const char* keys =
    "[space] pause  [.] image  [,] sample  [n] next miss  [+ -] speed  "
    "[>] 5 s on  [q] quit";

void obey(char key, vehicle::Vehicle& vehicle, vehicle::Player& player) {
  switch (key) {
    case ' ':
      player.paused() ? player.resume() : player.pause();
      break;
    case '.':
      player.step_image();
      break;
    case ',':
      player.step_sample();
      break;
    case 'n':
      player.play_to_next_miss();
      break;
    case '+':
      player.set_speed(player.speed() * 2.0);
      break;
    case '-':
      player.set_speed(player.speed() / 2.0);
      break;
    case '>':
      player.seek(vehicle.position() + std::chrono::seconds(5));
      break;
    case 'q':
      vehicle.stop();
      break;
    default:
      break;
  }
}

void show_progress(const vehicle::Vehicle& vehicle, const vehicle::Player& player, Time last,
                   const char* help) {
  const double all = std::max(to_seconds(last - vehicle.first()), 1e-3);
  const double done = std::clamp(to_seconds(vehicle.position() - vehicle.first()), 0.0, all);
  const char* state = player.seeking() ? "seeking" : player.paused() ? "paused" : "";
  std::fprintf(stderr, "\r%8.1f s of %.1f s  %3.0f %%  x%-6g %-7s %s\x1b[K", done, all,
               100.0 * done / all, player.speed(), state, help);
}

}  // namespace

PlaybackEnd play(vehicle::Vehicle& vehicle, Time last, const PlaybackOptions& options) {
  constexpr auto look_every = std::chrono::milliseconds(20);
  constexpr int show_every = 10;
  const bool visible = isatty(STDERR_FILENO) != 0;
  const Keyboard keyboard;
  vehicle::Player player(vehicle);
  interrupt_once();

  bool quit = false;
  vehicle.start();
  if (vehicle.clock().is_paced()) {
    const runtime::RealtimeReport& readiness = vehicle.readiness();
    std::cerr << (options.verbose ? to_text(readiness) : to_short_text(readiness));
    if (options.start > 0.0) player.seek(vehicle.first() + from_seconds(options.start));
    if (options.until_miss) player.play_to_next_miss();
    if (options.paused) player.pause();
  }
  for (int i = 0; vehicle.running(); ++i) {
    if (interrupted != 0) vehicle.stop();
    if (vehicle.clock().is_paced()) {
      while (const auto key = keyboard.pressed()) {
        quit = quit || *key == 'q';
        obey(*key, vehicle, player);
      }
      player.update();
    }
    if (visible && i % show_every == 0) {
      show_progress(vehicle, player, last, keyboard.is_terminal() ? keys : "");
    }
    std::this_thread::sleep_for(look_every);
  }
  vehicle.wait();
  if (visible) std::fprintf(stderr, "\r\x1b[K");
  return interrupted != 0 || quit ? PlaybackEnd::interrupted : PlaybackEnd::finished;
}

}  // namespace maploop::tools
