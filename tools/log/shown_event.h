// What viewers such as Foxglove are shown of an LCM event: its message in JSON, under the channel's
// own name, and positions, poses, images and clouds in Foxglove's schemas (foxglove_messages.h).
// Channels of images and clouds are not in JSON.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

// The texts are made when they are asked for, which must be within use().
struct ShownMessage {
  std::string_view topic, schema_name;
  std::function<std::string()> schema;  // JSON schema
  std::function<std::string()> json;
};

void show(const LogEvent& event, const schema::Schema& schema,
          const std::function<void(const ShownMessage&)>& use);

// Returns by how many topics an event of a channel is shown, if it shows all that it can.
std::size_t most_shown(std::string_view channel);

}  // namespace maploop::lcm_log
