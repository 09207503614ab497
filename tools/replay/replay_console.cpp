#include "tools/replay/replay_console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>

#include "tools/command/terminal.h"

namespace maploop::tools {
namespace {

constexpr const char* keys =
    "[space] pause  [.] image  [,] sample  [n] next miss  [+ -] speed  "
    "[< >] 5 s  [q] quit";

// The nearest moment that the recording has.
void jump(vehicle::Player& player, Duration by) {
  player.seek(std::clamp(player.position() + by, player.first(), player.last()));
}

void obey(char key, vehicle::Player& player) {
  constexpr auto far = std::chrono::seconds(5);
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
      jump(player, far);
      break;
    case '<':
      jump(player, -far);
      break;
    case 'q':
      player.quit();
      break;
    default:
      break;
  }
}

void show_progress(const vehicle::Player& player, const char* help) {
  const double all = std::max(to_seconds(player.last() - player.vehicle().first()), 1e-3);
  const double done =
      std::clamp(to_seconds(player.position() - player.vehicle().first()), 0.0, all);
  const char* state = player.seeking() ? "seeking" : player.paused() ? "paused" : "";
  show_status(STDERR_FILENO, fmt::format("{:8.1f} s of {:.1f} s  {:3.0f} %  x{:<6g} {:7} {}", done,
                                         all, 100.0 * done / all, player.speed(), state, help));
}

}  // namespace

PlaybackEnd play(vehicle::Player& player, vehicle::ReplayControl* control,
                 vehicle::RunPresence* presence, const PlaybackOptions& options, bool verbose) {
  constexpr auto look_every = std::chrono::milliseconds(20);
  constexpr int show_every = 10;
  const bool visible = is_screen(STDERR_FILENO);
  const Keyboard keyboard;
  note_interrupts();

  bool quit = false;
  player.start();
  const bool paced = player.vehicle().clock().is_paced();
  if (paced) {
    const runtime::RealtimeReport& readiness = player.vehicle().readiness();
    std::cerr << (verbose ? to_text(readiness) : to_short_text(readiness));
    if (options.until_miss) player.play_to_next_miss();
    if (options.paused) player.pause();
  }
  for (int i = 0; player.update(); ++i) {
    if (interrupted()) player.quit();
    if (presence != nullptr) presence->update();
    if (paced) {
      while (const auto key = keyboard.pressed()) {
        quit = quit || *key == 'q';
        obey(*key, player);
      }
      if (control != nullptr) control->update();
    }
    if (visible && i % show_every == 0) show_progress(player, keyboard.is_terminal() ? keys : "");
    std::this_thread::sleep_for(look_every);
  }
  player.vehicle().wait();
  if (visible) show_status(STDERR_FILENO, "");
  quit = quit || (control != nullptr && control->quit());
  return interrupted() || quit ? PlaybackEnd::interrupted : PlaybackEnd::finished;
}

}  // namespace maploop::tools
