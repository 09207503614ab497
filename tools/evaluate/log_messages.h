// Reads the messages of our own logs: LCM logs, and the same messages in an MCAP file or a bag.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "msgs/lcm/log/log_event.h"

namespace maploop::evaluation {

// Whether a file is such a log, by its first bytes (.gz: by its name).
bool is_lcm_log(const std::filesystem::path& file);

// Reads a plain or .gz file. Throws std::runtime_error naming the file if it cannot be read or is
// damaged.
void visit_log(const std::filesystem::path& file,
               const std::function<void(const lcm_log::LogEvent&)>& visit);

// Decodes an event as one of our structs. Throws std::runtime_error if it is not such a message.
template <class Lcm>
auto decoded(const lcm_log::LogEvent& event, const std::filesystem::path& file) {
  const std::string where = file.string() + ": event " + std::to_string(event.number) + " on " +
                            std::string(event.channel) + ": ";
  Lcm message;
  if (!schema::checked_decode(schema::own_schema(), event.data, message))
    throw std::runtime_error(where + "no " + Lcm::getTypeName() + " of this version");
  try {
    return from_lcm(message);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(where + e.what());
  }
}

}  // namespace maploop::evaluation
