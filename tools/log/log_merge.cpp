#include <fmt/ostream.h>

#include <algorithm>
#include <memory>
#include <ostream>
#include <vector>

#include "sensors/replay/log_events.h"
#include "tools/command/progress.h"
#include "tools/log/log_tools.h"
#include "tools/log/log_writer.h"

namespace maploop::lcm_log {

LogSummary merge(std::span<const path> logs, const schema::Schema& schema, const path& output,
                 std::ostream& out) {
  LogSummary result;
  // Advances to the reader's next event; returns false at the end of its log.
  const auto advance = [&](sensors::LogEvents& reader) {
    for (auto item = reader.next(); item != sensors::LogEvents::Item::end; item = reader.next()) {
      if (item == sensors::LogEvents::Item::event) return true;
      ++result.damages;
      result.damaged_bytes += reader.damage().bytes();
    }
    return false;
  };
  // Each reader is at an event; they are in the order of `logs`.
  std::vector<std::unique_ptr<sensors::LogEvents>> waiting;
  std::uint64_t all_bytes = 0;
  for (const path& log : logs) {
    refuse_same_file(log, output);
    auto reader = sensors::open_log(log, schema);
    all_bytes += reader->file_size();
    if (advance(*reader)) waiting.push_back(std::move(reader));
  }
  LogWriter writer(output, schema);
  tools::Progress progress("MB");
  while (!waiting.empty()) {
    const auto earliest = std::min_element(
        waiting.begin(), waiting.end(),
        [](const auto& a, const auto& b) { return a->event().time_us < b->event().time_us; });
    writer.write((*earliest)->event());
    progress.at(1e-6 * static_cast<double>(std::min(writer.bytes(), all_bytes)),
                1e-6 * static_cast<double>(all_bytes));
    if (!advance(**earliest)) waiting.erase(earliest);
  }
  writer.close();
  result.events = writer.events();
  fmt::print(out, "{} events of {} logs written to {}\n", result.events, logs.size(),
             output.string());
  return result;
}

}  // namespace maploop::lcm_log
