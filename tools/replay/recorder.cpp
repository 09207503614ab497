#include "tools/replay/recorder.h"

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/log/log_header.h"
#include "tools/log/log_writer.h"
#include "tools/log/mcap_log.h"

namespace maploop::tools {
namespace {

class McapFormat final : public vehicle::LogFormat {
 public:
  explicit McapFormat(vehicle::RecordedFile& file)
      : log_([&file](std::string_view part) { return append(file, part); }, schema::own_schema()) {}

  std::size_t write(const vehicle::LogBatch& batch) override {
    std::size_t begin = 0;
    for (const std::size_t end : batch.ends) {
      log_.write(event_of(std::span(batch.bytes).subspan(begin, end - begin)));
      begin = end;
    }
    return newly_lost();
  }
  std::size_t flush() override {
    log_.flush();
    return newly_lost();
  }
  std::size_t finish() override {
    log_.close();
    return newly_lost();
  }

 private:
  static bool append(vehicle::RecordedFile& file, std::string_view part) {
    const std::array end{part.size()};
    return file.append({reinterpret_cast<const std::uint8_t*>(part.data()), part.size()}, end) == 1;
  }
  static lcm_log::LogEvent event_of(std::span<const std::uint8_t> bytes) {
    const lcm_log::LogHeader header = lcm_log::read_header(bytes);
    const auto channel_bytes = static_cast<std::size_t>(header.channel_bytes);
    const auto content = bytes.subspan(lcm_log::header_bytes);
    return {.number = header.number,
            .time_us = header.time_us,
            .channel = {reinterpret_cast<const char*>(content.data()), channel_bytes},
            .data = content.subspan(channel_bytes)};
  }
  std::size_t newly_lost() { return log_.lost() - std::exchange(told_, log_.lost()); }

  lcm_log::McapLog log_;
  std::uint64_t told_ = 0;  // of the lost ones
};

}  // namespace

std::unique_ptr<vehicle::LogRecorder> make_recorder(const std::filesystem::path& file, bool raw,
                                                    vehicle::LogRecorder::WhenBehind when_behind) {
  if (lcm_log::is_bag_name(file)) {
    throw std::runtime_error("'" + file.string() +
                             "': a run is not recorded as a bag; record a log or an .mcap file, "
                             "and convert it with 'maploop log convert'");
  }
  if (!lcm_log::is_mcap_name(file))
    return std::make_unique<vehicle::LogRecorder>(file.string(), raw, when_behind);
  return std::make_unique<vehicle::LogRecorder>(
      file.string(), raw, when_behind,
      [](vehicle::RecordedFile& recorded) { return std::make_unique<McapFormat>(recorded); });
}

}  // namespace maploop::tools
