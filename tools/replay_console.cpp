#include "tools/replay_console.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <thread>

#include "runtime/vehicle/player.h"
#include "tools/terminal.h"

namespace maploop::tools {
namespace {

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
  note_interrupts();

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
    if (interrupted()) vehicle.stop();
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
  return interrupted() || quit ? PlaybackEnd::interrupted : PlaybackEnd::finished;
}

}  // namespace maploop::tools
