#include <fmt/ostream.h>

#include <ostream>
#include <set>
#include <stdexcept>
#include <string>

#include "tools/log/log_tools.h"
#include "tools/log/log_writer.h"

namespace maploop::lcm_log {

LogSummary convert(const path& log, const schema::Schema& schema, const path& output,
                   const std::string& bag_compression, std::ostream& out) {
  refuse_same_file(log, output);
  LogWriter writer(output, schema, bag_compression);
  std::set<std::string, std::less<>> channels;
  std::uint64_t unknown = 0;
  const LogSummary read = read_log(log, schema, [&](const LogEvent& event) {
    writer.write(event);
    if (channels.size() < most_channels) channels.emplace(event.channel);
    if (schema.find(schema::fingerprint_of(event.data)) == nullptr) ++unknown;
  });
  if (writer.events() == 0)
    throw std::runtime_error("'" + log.string() + "' has no messages: nothing is written");
  writer.close();
  fmt::print(out, "{}: {} messages of {} channels", output.string(), writer.events(),
             channels.size());
  if (unknown > 0 && (is_mcap_name(output) || is_bag_name(output))) {
    fmt::print(out, "; {} of unknown types cannot be shown (--types names the files of theirs)",
               unknown);
  }
  out << '\n';
  return read;
}

}  // namespace maploop::lcm_log
