// Damaged copies of text, for the tests of what reads it.
#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <string_view>

namespace maploop::testing {

// Cut somewhere, one to four bits flipped, a piece of less than `longest` bytes taken out or
// doubled, or bytes of `alphabet` anywhere.
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
