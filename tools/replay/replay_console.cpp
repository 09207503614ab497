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

using vehicle::Player;

constexpr const char* help =
    "[space] pause  [.] image  [,] sample  [n] next miss  [+ -] speed  "
    "[< >] 5 s  [q] quit";

// Goes to the nearest moment that the recording has.
void jump(Player& player, Duration by) {
  player.seek(std::clamp(player.position() + by, player.first(), player.last()));
}

constexpr struct {
  char key;
  void (*act)(Player&);
} keys[] = {
    {' ', [](Player& p) { p.paused() ? p.resume() : p.pause(); }},
    {'.', [](Player& p) { p.step_image(); }},
    {',', [](Player& p) { p.step_sample(); }},
    {'n', [](Player& p) { p.play_to_next_miss(); }},
    {'+', [](Player& p) { p.set_speed(p.speed() * 2.0); }},
    {'-', [](Player& p) { p.set_speed(p.speed() / 2.0); }},
    {'>', [](Player& p) { jump(p, std::chrono::seconds(5)); }},
    {'<', [](Player& p) { jump(p, -std::chrono::seconds(5)); }},
    {'q', [](Player& p) { p.quit(); }},
};

void obey(char pressed, Player& player) {
  for (const auto& [key, act] : keys) {
    if (key == pressed) act(player);
  }
}

void show_progress(const Player& player, bool obeys_keys) {
  const double all = std::max(to_seconds(player.last() - player.vehicle().first()), 1e-3);
  const double done =
      std::clamp(to_seconds(player.position() - player.vehicle().first()), 0.0, all);
  const char* state = player.seeking() ? "seeking" : player.paused() ? "paused" : "";
  show_status(STDERR_FILENO,
              fmt::format("{:8.1f} s of {:.1f} s  {:3.0f} %  x{:<6g} {:7} {}", done, all,
                          100.0 * done / all, player.speed(), state, obeys_keys ? help : ""));
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
    if (visible && i % show_every == 0) show_progress(player, keyboard.is_terminal());
    std::this_thread::sleep_for(look_every);
  }
  player.vehicle().wait();
  if (visible) show_status(STDERR_FILENO, "");
  quit = quit || (control != nullptr && control->quit());
  return interrupted() || quit ? PlaybackEnd::interrupted : PlaybackEnd::finished;
}

}  // namespace maploop::tools
