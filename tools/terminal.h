// What the commands that run for a while share of their terminal: keys, and a clean end at Ctrl-C.
#pragma once

#include <termios.h>

#include <optional>

namespace maploop::tools {

// From now on SIGINT and SIGTERM are noted instead of ending the program; a second one ends it.
void note_interrupts();
// Whether one has come.
bool interrupted();

// Single keys of standard input, unechoed, as long as it lives; nothing where that is no terminal.
class Keyboard {
 public:
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  bool is_terminal() const { return terminal_; }

  // The next key that waits; one of several bytes (an arrow) is one key after another.
  std::optional<char> pressed() const;

 private:
  termios before_{};
  bool terminal_;
};

}  // namespace maploop::tools
