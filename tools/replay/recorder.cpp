#include "tools/replay/recorder.h"

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/log/log_header.h"
#include "runtime/vehicle/output/recorded_file.h"
#include "tools/log/log_writer.h"
#include "tools/log/mcap_log.h"

namespace maploop::tools {
namespace {

class McapFormat final : public vehicle::LogFormat {
 public:
  explicit McapFormat(const std::string& file)
      : file_(file),
        log_([this](std::string_view part) { return append(part); }, schema::own_schema()) {}

  std::size_t write(const vehicle::LogBatch& batch) override {
    std::size_t begin = 0;
    for (const std::size_t end : batch.ends) {
      log_.write(lcm_log::whole_event(std::span(batch.bytes).subspan(begin, end - begin)));
      begin = end;
    }
    return newly_lost();
  }
  std::size_t flush() override {
    log_.flush();
    file_.sync();
    return newly_lost();
  }
  std::size_t finish() override {
    log_.close();
    file_.sync();
    return newly_lost();
  }

 private:
  bool append(std::string_view part) {
    const std::array end{part.size()};
    return file_.append({reinterpret_cast<const std::uint8_t*>(part.data()), part.size()}, end) ==
           1;
  }
  std::size_t newly_lost() { return log_.lost() - std::exchange(told_, log_.lost()); }

  vehicle::RecordedFile file_;
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
      [](const std::string& name) { return std::make_unique<McapFormat>(name); });
}

}  // namespace maploop::tools
