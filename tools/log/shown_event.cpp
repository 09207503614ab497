#include "tools/log/shown_event.h"

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/decoded_message.h"
#include "tools/log/foxglove_messages.h"
#include "tools/log/message_json.h"

namespace maploop::lcm_log {
namespace {

bool is_pictured(std::string_view channel) {
  return channel == channel_names::camera || channel == channel_names::velodyne;
}

}  // namespace

void show(const LogEvent& event, const schema::Schema& schema,
          const std::function<void(const ShownMessage&)>& use) {
  const schema::Type* type = schema.find(schema::fingerprint_of(event.data));
  if (const auto message =
          is_pictured(event.channel) ? std::nullopt : schema::try_decode(schema, event.data)) {
    use({event.channel, type->name, [&] { return json_schema(*type); },
         [&] { return to_json(*message); }});
  }
  show_in_foxglove(event, schema, [&](const FoxgloveMessage& shown) {
    use({shown.topic, shown.schema_name, [&] { return foxglove_schema(shown.schema_name); },
         [&] { return shown.json; }});
  });
}

std::size_t most_shown(std::string_view channel) {
  return foxglove_topics(channel).size() + (is_pictured(channel) ? 0U : 1U);
}

}  // namespace maploop::lcm_log
