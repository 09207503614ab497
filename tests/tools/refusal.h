#pragma once

#include <stdexcept>
#include <string>

namespace maploop::testing {

// Returns the message of the exception that it throws, or "accepted".
template <class Read>
std::string refusal(Read&& read) {
  try {
    read();
    return "accepted";
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

}  // namespace maploop::testing
