#include "tools/terminal.h"

#include <poll.h>
#include <unistd.h>

#include <csignal>

namespace maploop::tools {
namespace {

volatile std::sig_atomic_t signalled = 0;

}  // namespace

void note_interrupts() {
  struct sigaction action {};
  action.sa_handler = [](int) { signalled = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() {
  return signalled != 0;
}

Keyboard::Keyboard()
    : terminal_(isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &before_) == 0) {
  if (!terminal_) return;
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  tcsetattr(STDIN_FILENO, TCSANOW, &raw);
}

Keyboard::~Keyboard() {
  if (terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

std::optional<char> Keyboard::pressed() const {
  pollfd ready{STDIN_FILENO, POLLIN, 0};
  char key = 0;
  if (!terminal_ || poll(&ready, 1, 0) != 1 || read(STDIN_FILENO, &key, 1) != 1) return {};
  return key;
}

}  // namespace maploop::tools
