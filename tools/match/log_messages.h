// Reads the messages of an LCM log in order.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "msgs/lcm/log/log_event.h"

namespace maploop::match {

// Whether a file is an LCM log, by its first bytes (.gz: by its name).
bool is_lcm_log(const std::filesystem::path& file);

// Reads a plain or .gz file. Throws std::runtime_error naming the file if it cannot be read or is
// damaged.
void visit_log(const std::filesystem::path& file,
               const std::function<void(const lcm_log::LogEvent&)>& visit);

// Decodes an event as one of our structs. Throws std::runtime_error if it is not such a message.
template <class Lcm>
auto decoded(const lcm_log::LogEvent& event, const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(file.string() + ": event " + std::to_string(event.number) + " on " +
                             std::string(event.channel) + ": " + why);
  };
  Lcm message;
  if (!schema::checked_decode(schema::own_schema(), event.data, message))
    refuse(std::string("no ") + Lcm::getTypeName() + " of this version");
  try {
    return from_lcm(message);
  } catch (const std::invalid_argument& e) {
    refuse(e.what());
    throw;
  }
}

}  // namespace maploop::match
