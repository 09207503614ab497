// Converts what the vehicle sends to messages that Foxglove shows on its map and in its scene.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

struct FoxgloveMessage {
  std::string_view topic;
  std::string_view schema_name;
  std::string json;
};

// Calls use(message) for each view of an event (event_views.h) that has a schema of Foxglove.
void show_in_foxglove(const LogEvent& event, const schema::Schema& schema,
                      const std::function<void(const FoxgloveMessage&)>& use);

struct FoxgloveTopic {
  std::string_view name, schema_name;
};

// Returns the topics that show the events of a channel; none for most channels.
std::span<const FoxgloveTopic> foxglove_topics(std::string_view channel);

// Returns the JSON schema of one of these names.
std::string foxglove_schema(std::string_view schema_name);

}  // namespace maploop::lcm_log
