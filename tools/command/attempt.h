// Goes on after a failure that has been said.
#pragma once

#include <exception>
#include <iostream>

namespace maploop::tools {

// Calls `act`, and says on standard error what it throws. Returns whether it succeeded.
bool attempt(const auto& act) {
  try {
    act();
    return true;
  } catch (const std::exception& e) {
    std::cerr << "maploop: " << e.what() << '\n';
    return false;
  }
}

}  // namespace maploop::tools
