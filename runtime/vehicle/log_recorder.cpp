#include "runtime/vehicle/log_recorder.h"

#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

namespace maploop::vehicle {

struct LogRecorder::File {
  explicit File(const std::string& path) : log(path, "w") {}
  lcm::LogFile log;
};

LogRecorder::LogRecorder(const std::string& path, bool raw)
    : file_(std::make_unique<File>(path)), raw_(raw) {
  if (!file_->log.good()) {
    throw std::runtime_error("cannot write the log '" + path +
                             "': check that its folder exists and may be written");
  }
}

LogRecorder::~LogRecorder() = default;

bool LogRecorder::take(const Message& message) {
  lcm::LogEvent event{};
  event.timestamp =
      std::chrono::floor<std::chrono::microseconds>(message.time).time_since_epoch().count();
  event.channel = message.channel;
  event.datalen = static_cast<std::int32_t>(message.data.size());
  event.data = const_cast<std::uint8_t*>(message.data.data());  // LCM only reads it
  return file_->log.writeEvent(&event) == 0;
}

}  // namespace maploop::vehicle
