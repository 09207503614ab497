// Recordings of ROS: bags, MCAP files and databases of rosbag2, read to their end.
#include <algorithm>
#include <optional>
#include <stdexcept>

#include "sensors/bag/message_reader.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

namespace {

void read(const std::filesystem::path& file, const sensors::MessageSelection& selection) {
  const auto reader = sensors::open_messages(file, selection);
  unsigned sum = 0;
  using Item = sensors::MessageReader::Item;
  for (Item item = reader->next(); item != Item::end; item = reader->next()) {
    if (item == Item::damage) {
      fuzz::require(!reader->damage().reason.empty());
      continue;
    }
    const auto& message = reader->message();
    fuzz::require(message.received >= selection.begin);
    for (const std::uint8_t b : message.data.first(std::min<std::size_t>(message.data.size(), 99)))
      sum += b;
    if (!message.data.empty()) sum += message.data.back();
    sum += static_cast<unsigned>(message.topic->name.size() + message.topic->definition.size());
  }
  volatile unsigned sink = sum;
  (void)sink;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // SQLite resolves the file's name, which a file in memory does not have.
  const bool database = size > 6 && std::equal(data, data + 6, "SQLite");
  std::optional<fuzz::NamedFile> named;
  if (database) named.emplace("input.db3").write({data, size});
  const fuzz::MemoryFile in_memory(data, size);
  const auto file = database ? named->path() : in_memory.path();
  try {
    read(file, {});
    read(file, {{"/imu"}, from_nanoseconds(1'000'000'000)});
    for (const auto& topic : sensors::summarize(file).topics)
      fuzz::require(topic.messages > 0 && topic.first <= topic.last);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
