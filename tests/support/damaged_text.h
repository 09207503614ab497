// Makes damaged copies of text, for the tests of its readers.
#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <string_view>

namespace maploop::testing {

// Returns `text` cut somewhere, or with one to four bits flipped, with a piece of less than
// `longest` bytes removed or doubled, or with one to eight bytes anywhere replaced by bytes of
// `alphabet`.
inline std::string damaged(std::string text, std::mt19937& random, std::size_t longest,
                           std::string_view alphabet) {
  const auto place = [&] { return text.empty() ? 0 : random() % text.size(); };
  switch (random() % 5) {
    case 0:
      text.resize(place());
      break;
    case 1:
      for (unsigned n = 1 + random() % 4; n > 0 && !text.empty(); --n) {
        char& c = text[place()];
        c = static_cast<char>(c ^ (1 << random() % 8));
      }
      break;
    case 2:
      text.erase(place(), random() % longest);
      break;
    case 3:
      text.insert(place(), text.substr(place(), random() % longest));
      break;
    default:
      for (unsigned n = 1 + random() % 8; n > 0 && !text.empty(); --n) {
        text[place()] = alphabet[random() % alphabet.size()];
      }
  }
  return text;
}

}  // namespace maploop::testing
