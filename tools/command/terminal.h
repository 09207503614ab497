// What the commands that run for a while share of their terminal: keys, and a clean end at Ctrl-C.
#pragma once

#include <termios.h>

#include <cstddef>
#include <optional>
#include <string>

namespace maploop::tools {

// From now on SIGINT, SIGTERM and SIGHUP are noted instead of ending the program. What comes within
// a second of the first is the same wish, as where a program that ends this one signals its whole
// group; a later one ends the program at once, with the terminal as it was before. A SIGHUP that
// whoever started the program has turned off (nohup) stays off.
void note_interrupts();
// Whether one has come.
bool interrupted();
// What a shell reports of a program that such a signal has ended, 128 and its number: 130 of
// Ctrl-C, and of keys and commands that end the program likewise.
int interrupted_status();

// Whether the stream (STDOUT_FILENO, STDERR_FILENO) is a terminal that understands escape codes.
bool is_screen(int stream);
// Gives the words that begin lines the colour of their meaning ("granted", "limiting", "refused",
// "Note:", "maploop:"). Returns `text` as it is where the stream is no screen, or NO_COLOR is set.
std::string in_colour(int stream, const std::string& text);
// Of the terminal behind the stream; 80 where it is none.
std::size_t columns_of(int stream);
// Writes `text` over the status line, cut to the terminal's width; an empty one clears the line.
void show_status(int stream, const std::string& text);

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
