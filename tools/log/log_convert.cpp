#include <fmt/ostream.h>

#include <algorithm>
#include <map>
#include <ostream>
#include <stdexcept>
#include <utility>

#include "msgs/lcm/decoded_message.h"
#include "tools/log/foxglove_messages.h"
#include "tools/log/log_tools.h"
#include "tools/log/mcap_writer.h"
#include "tools/log/message_json.h"

namespace maploop::lcm_log {

LogSummary convert(const path& log, const schema::Schema& schema, const path& output,
                   std::ostream& out) {
  refuse_same_file(log, output);
  McapWriter writer(output);
  std::map<std::pair<std::string, std::string>, std::uint16_t> channels;  // by topic and schema
  const auto channel = [&](const std::string& topic, const std::string& type, auto schema_of) {
    const auto found = channels.find({topic, type});
    if (found != channels.end()) return found->second;
    if (channels.size() == most_channels) {
      throw std::runtime_error("'" + log.string() + "' has more than " +
                               std::to_string(most_channels) + " channels");
    }
    return channels[{topic, type}] = writer.add_channel(topic, type, schema_of());
  };
  std::uint64_t unknown = 0;
  const LogSummary read = read_log(log, schema, [&](const LogEvent& event) {
    constexpr std::int64_t most_us = std::int64_t{1} << 53;
    const std::int64_t time = 1000 * std::clamp<std::int64_t>(event.time_us, 0, most_us);
    const schema::Type* type = schema.find(schema::fingerprint_of(event.data));
    const auto message = schema::try_decode(schema, event.data);
    if (!message) {
      ++unknown;
      return;
    }
    writer.write(
        channel(std::string(event.channel), type->name, [&] { return json_schema(*type); }), time,
        to_json(*message));
    show_in_foxglove(event, schema, [&](const FoxgloveMessage& shown) {
      const auto schema_of = [&] { return foxglove_schema(shown.schema_name); };
      writer.write(channel(shown.topic, shown.schema_name, schema_of), time, shown.json);
    });
  });
  if (writer.messages() == 0) {
    throw std::runtime_error("'" + log.string() +
                             "' has no message of a known type; --types "
                             "names the files of others");
  }
  writer.close();
  fmt::print(out, "{}: {} messages of {} channels", output.string(), writer.messages(),
             channels.size());
  if (unknown > 0) fmt::print(out, "; {} of unknown types were left out", unknown);
  out << '\n';
  return read;
}

}  // namespace maploop::lcm_log
