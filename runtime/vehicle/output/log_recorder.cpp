#include "runtime/vehicle/output/log_recorder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "msgs/lcm/log/log_header.h"

namespace maploop::vehicle {
namespace {

// A process that is killed loses at most the messages of this time.
constexpr auto write_every = std::chrono::milliseconds(100);

void append(LogBatch& batch, std::int64_t number, const Message& message) {
  std::array<std::uint8_t, lcm_log::header_bytes> header{};
  lcm_log::write_header(
      {.sync = lcm_log::sync_word,
       .number = number,
       .time_us =
           std::chrono::floor<std::chrono::microseconds>(message.time).time_since_epoch().count(),
       .channel_bytes = static_cast<std::int32_t>(message.channel.size()),
       .data_bytes = static_cast<std::int32_t>(message.data.size())},
      header);
  batch.bytes.insert(batch.bytes.end(), header.begin(), header.end());
  batch.bytes.insert(batch.bytes.end(), message.channel.begin(), message.channel.end());
  batch.bytes.insert(batch.bytes.end(), message.data.begin(), message.data.end());
  batch.ends.push_back(batch.bytes.size());
}

}  // namespace

class LogRecorder::File {
 public:
  explicit File(const std::string& path)
      : descriptor_(open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) {
      throw std::runtime_error("cannot write the log '" + path + "': " + std::strerror(errno) +
                               "; check that its folder exists and may be written");
    }
    struct stat status {};
    if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) return;  // such as /dev/null
    // Two recordings into one file would be mixed. The lock lasts as long as the descriptor.
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(descriptor_);
      throw std::runtime_error("cannot write the log '" + path +
                               "': another run is recording to it; name another file (--record)");
    }
    if (ftruncate(descriptor_, 0) != 0) {
      close(descriptor_);
      throw std::runtime_error("cannot empty the log '" + path + "': " + std::strerror(errno));
    }
  }
  ~File() { close(descriptor_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  // Returns how many of the events were written.
  std::size_t write(const LogBatch& batch) {
    const std::size_t written = put(batch.bytes);
    if (written == batch.bytes.size()) {
      size_ += static_cast<off_t>(written);
      return batch.ends.size();
    }
    // The file is cut after its last whole event; a device cannot be cut.
    const auto cut = std::upper_bound(batch.ends.begin(), batch.ends.end(), written);
    if (cut != batch.ends.begin()) size_ += static_cast<off_t>(*(cut - 1));
    if (ftruncate(descriptor_, size_) == 0) lseek(descriptor_, size_, SEEK_SET);
    return static_cast<std::size_t>(cut - batch.ends.begin());
  }

  void sync() { fsync(descriptor_); }

 private:
  std::size_t put(const std::vector<std::uint8_t>& bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t written = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) break;
      done += static_cast<std::size_t>(written);
    }
    return done;
  }

  int descriptor_;
  off_t size_ = 0;  // bytes of whole events
};

LogRecorder::LogRecorder(const std::string& path, bool raw, WhenBehind when_behind)
    : file_(std::make_unique<File>(path)),
      raw_(raw),
      when_behind_(when_behind),
      writer_(
          "log", {}, end_.get_token(), [this](const std::stop_token& end) { write_batches(end); },
          [] {}) {}

LogRecorder::~LogRecorder() {
  end_.request_stop();
  writer_.join();
  file_->sync();
}

bool LogRecorder::take(const Message& message) {
  std::unique_lock lock(mutex_);
  const auto has_room = [this] { return filling_.bytes.size() < max_pending_bytes; };
  if (!has_room()) {
    changed_.notify_all();
    if (when_behind_ == WhenBehind::drop) return false;
    changed_.wait(lock, has_room);
  }
  append(filling_, events_++, message);
  return true;
}

void LogRecorder::flush() {
  std::unique_lock lock(mutex_);
  flushing_ = true;
  changed_.notify_all();
  changed_.wait(lock, [this] { return filling_.ends.empty() && !writing_; });
  flushing_ = false;
  lock.unlock();
  file_->sync();
}

// Two batches alternate, so that their memory is reused.
void LogRecorder::write_batches(const std::stop_token& end) {
  LogBatch batch;
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait_for(lock, end, write_every,
                      [this] { return flushing_ || filling_.bytes.size() >= max_pending_bytes; });
    const bool last = end.stop_requested();
    if (filling_.ends.empty()) {
      if (last) return;
      if (flushing_) changed_.wait_for(lock, write_every);
      continue;
    }
    std::swap(batch, filling_);
    writing_ = true;
    changed_.notify_all();
    lock.unlock();
    unsend(batch.ends.size() - file_->write(batch));
    batch.bytes.clear();
    batch.ends.clear();
    lock.lock();
    writing_ = false;
    changed_.notify_all();
  }
}

}  // namespace maploop::vehicle
