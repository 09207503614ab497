#include "tools/command/terminal.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace maploop::tools {
namespace {

volatile std::sig_atomic_t signalled = 0;  // which came first
timespec signalled_at{};                   // written by the first alone
// Of the Keyboard that lives; null: the terminal is as it was.
std::atomic<const termios*> terminal_before{nullptr};
static_assert(std::atomic<const termios*>::is_always_lock_free);

// Calls what a signal may call alone.
void hear(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (signalled == 0) {
    signalled_at = now;
    signalled = signal;
    return;
  }
  const bool same_wish =
      now.tv_sec - signalled_at.tv_sec < (now.tv_nsec < signalled_at.tv_nsec ? 2 : 1);
  if (same_wish) return;
  if (const termios* before = terminal_before.load()) tcsetattr(STDIN_FILENO, TCSANOW, before);
  std::signal(signal, SIG_DFL);
  raise(signal);
}

}  // namespace

void note_interrupts() {
  struct sigaction action {};
  action.sa_handler = hear;
  // One at a time.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&action.sa_mask, signal);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

bool interrupted() {
  return signalled != 0;
}

int interrupted_status() {
  return 128 + (signalled != 0 ? signalled : SIGINT);
}

bool is_screen(int stream) {
  const char* terminal = std::getenv("TERM");
  return isatty(stream) != 0 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

std::string in_colour(int stream, const std::string& text) {
  const char* unwanted = std::getenv("NO_COLOR");  // https://no-color.org
  if (!is_screen(stream) || (unwanted != nullptr && *unwanted != '\0')) return text;
  constexpr int good = 32, warning = 33, bad = 31;  // of ECMA-48
  struct Word {
    std::string_view word;
    int colour;
  };
  constexpr std::array words{Word{"granted", good},    Word{"limiting", warning},
                             Word{"unknown", warning}, Word{"Note:", warning},
                             Word{"refused", bad},     Word{"maploop:", bad}};
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    const auto* const found = std::find_if(words.begin(), words.end(),
                                           [&](const Word& w) { return line.starts_with(w.word); });
    if (found == words.end()) {
      result += line;
    } else {
      result +=
          "\x1b[" + std::to_string(found->colour) + 'm' + std::string(found->word) + "\x1b[0m";
      result += line.substr(found->word.size());
    }
    begin = end;
  }
  return result;
}

std::size_t columns_of(int stream) {
  constexpr std::size_t usual = 80;
  winsize size{};
  return ioctl(stream, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

void show_status(int stream, const std::string& text) {
  const std::string line = "\r" + text.substr(0, columns_of(stream) - 1) + "\x1b[K";
  if (write(stream, line.data(), line.size()) < 0) return;  // nobody looks at it
}

Keyboard::Keyboard()
    : terminal_(isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &before_) == 0) {
  if (!terminal_) return;
  terminal_before = &before_;
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  tcsetattr(STDIN_FILENO, TCSANOW, &raw);
}

Keyboard::~Keyboard() {
  if (!terminal_) return;
  tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  terminal_before = nullptr;
}

std::optional<char> Keyboard::pressed() const {
  pollfd ready{STDIN_FILENO, POLLIN, 0};
  char key = 0;
  if (!terminal_ || poll(&ready, 1, 0) != 1 || read(STDIN_FILENO, &key, 1) != 1) return {};
  return key;
}

}  // namespace maploop::tools
