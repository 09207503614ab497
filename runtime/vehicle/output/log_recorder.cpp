#include "runtime/vehicle/output/log_recorder.h"

#include <array>
#include <chrono>
#include <utility>

#include "msgs/lcm/log/log_header.h"
#include "runtime/vehicle/output/recorded_file.h"

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

class LcmLogFormat final : public LogFormat {
 public:
  explicit LcmLogFormat(const std::string& file) : file_(file) {}

  std::size_t write(const LogBatch& batch) override {
    return batch.ends.size() - file_.append(batch.bytes, batch.ends);
  }
  std::size_t flush() override {
    file_.sync();
    return 0;
  }
  std::size_t finish() override { return flush(); }

 private:
  RecordedFile file_;
};

}  // namespace

std::unique_ptr<LogFormat> lcm_log_format(const std::string& file) {
  return std::make_unique<LcmLogFormat>(file);
}

LogRecorder::LogRecorder(const std::string& path, bool raw, WhenBehind when_behind,
                         const LogFormatOf& format)
    : format_(format(path)),
      raw_(raw),
      when_behind_(when_behind),
      writer_(
          "log", {}, end_.get_token(), [this](const std::stop_token& end) { write_batches(end); },
          [] {}) {}

LogRecorder::~LogRecorder() {
  end_.request_stop();
  writer_.join();
  unsend(format_->finish());
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
  unsend(format_->flush());  // the other thread has nothing to write
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
    unsend(format_->write(batch));
    batch.bytes.clear();
    batch.ends.clear();
    lock.lock();
    writing_ = false;
    changed_.notify_all();
  }
}

}  // namespace maploop::vehicle
