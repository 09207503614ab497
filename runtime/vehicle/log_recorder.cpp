#include "runtime/vehicle/log_recorder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

namespace maploop::vehicle {

namespace {

// The file, as long as it lives; two recordings into one would be mixed.
class Lock {
 public:
  // Of what is no file there is no need. Where the file cannot be opened, LCM says so next.
  explicit Lock(const std::string& path) {
    const auto status = std::filesystem::status(path);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) return;
    fd_ = open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (fd_ >= 0 && flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(fd_);
      throw std::runtime_error("cannot write the log '" + path +
                               "': another run is recording to it; name another file (--record)");
    }
  }
  ~Lock() {
    if (fd_ >= 0) close(fd_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int fd_ = -1;
};

}  // namespace

struct LogRecorder::File {
  explicit File(const std::string& path) : lock(path), log(path, "w") {}
  Lock lock;  // before LCM empties the file
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
