// Writes messages to a file: a standard LCM log, or another form of it.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "runtime/core/thread.h"
#include "runtime/vehicle/output/log_format.h"
#include "runtime/vehicle/output/message_sink.h"

namespace maploop::vehicle {

// Events carry the data's time, so that logs of the same drive have the same bytes at any speed,
// except for DEADLINES and HEALTH. A separate thread writes to the disk, so that the sender does
// not wait for the disk until the memory for pending events is full. An event that does not fit on
// the disk is counted as unsent.
class LogRecorder final : public MessageSink {
 public:
  // WhenBehind states what happens to a message when the memory for pending events is full.
  enum class WhenBehind {
    wait,  // wait for the disk: every message is in the log
    drop,  // drop and count it: a live run does not wait for a disk
  };
  // A message is accepted while fewer bytes than this are pending: two seconds of raw images and
  // scans.
  static constexpr std::size_t max_pending_bytes = std::size_t{64} << 20;

  // Replaces the file (recorded_file.h). With `raw` the log also contains the images and scans, so
  // that the whole graph can be replayed from it. Throws std::runtime_error naming the file if it
  // cannot be written, or if another recorder, of any process, is writing it.
  explicit LogRecorder(const std::string& path, bool raw = false,
                       WhenBehind when_behind = WhenBehind::wait,
                       const LogFormatOf& format = lcm_log_format);
  ~LogRecorder() override;

  std::string_view name() const override { return "log"; }
  bool wants_raw() const override { return raw_; }

  // Waits until every message sent is on the disk or counted as unsent.
  void flush() override;

 private:
  bool take(const Message& message) override;
  void write_batches(const std::stop_token& end);

  std::unique_ptr<LogFormat> format_;
  bool raw_;
  WhenBehind when_behind_;

  std::mutex mutex_;  // guards the members up to events_
  std::condition_variable_any changed_;
  LogBatch filling_;
  bool flushing_ = false;
  bool writing_ = false;
  std::int64_t events_ = 0;

  std::stop_source end_;
  runtime::Thread writer_;
};

}  // namespace maploop::vehicle
