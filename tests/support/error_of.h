// Returns what an action throws, for matchers such as HasSubstr.
#pragma once

#include <gmock/gmock-matchers.h>

#include <stdexcept>
#include <string>

namespace maploop::testing {

// The message of the Error that action() throws; an empty string if it throws none.
template <class Error = std::runtime_error, class Action>
std::string error_of(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace maploop::testing
