#include "tools/log/log_merge.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "msgs/lcm/log/log_reader.h"
#include "tools/log/log_writer.h"
#include "tools/log/progress.h"

namespace maploop::lcm_log {
namespace {

// Advances to the reader's next event; returns false at the end of its log.
bool next_event(LogReader& reader, MergeResult& result) {
  for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
    if (item == LogReader::Item::event) return true;
    ++result.damages;
    result.damaged_bytes += reader.damage().end - reader.damage().begin;
  }
  return false;
}

}  // namespace

MergeResult merge(std::span<const std::filesystem::path> logs, const schema::Schema& schema,
                  const std::filesystem::path& output) {
  MergeResult result;
  std::vector<std::unique_ptr<LogReader>> waiting;  // each at an event, in the order of `logs`
  std::uint64_t all_bytes = 0, done_bytes = 0;
  for (const auto& log : logs) {
    refuse_same_file(log, output);
    auto reader = std::make_unique<LogReader>(log, schema);
    all_bytes += reader->input().file_size();
    if (next_event(*reader, result)) waiting.push_back(std::move(reader));
  }
  LogWriter writer(output);
  Progress progress(all_bytes);
  while (!waiting.empty()) {
    const auto earliest = std::min_element(
        waiting.begin(), waiting.end(),
        [](const auto& a, const auto& b) { return a->event().time_us < b->event().time_us; });
    LogReader& reader = **earliest;
    writer.write(reader.event());
    done_bytes += reader.event().data.size() + reader.event().channel.size() + kHeaderBytes;
    progress.at(std::min(done_bytes, all_bytes));
    if (!next_event(reader, result)) waiting.erase(earliest);
  }
  writer.close();
  result.events = static_cast<std::uint64_t>(writer.events());
  return result;
}

}  // namespace maploop::lcm_log
