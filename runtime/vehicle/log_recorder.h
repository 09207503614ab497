// Messages in a standard LCM log, readable by every LCM tool.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/core/thread.h"
#include "runtime/vehicle/message_sink.h"

namespace maploop::vehicle {

// Whole events in memory, on their way to the disk.
struct LogBatch {
  std::vector<std::uint8_t> bytes;
  std::vector<std::size_t> ends;  // of each event in `bytes`
};

// Events carry the data's time, so that a log of the same drive has the same bytes at any speed,
// but for DEADLINES and HEALTH. A thread of its own writes to the disk: who sends does not wait for
// it while memory holds what is on its way. The file always ends with a whole event: one that the
// disk has no room for is taken back, and counted as unsent.
class LogRecorder final : public MessageSink {
 public:
  // What becomes of a message for which even memory has no room.
  enum class WhenBehind {
    wait,  // for the disk: every message is in the log
    drop,  // and count it: nobody waits for a disk on the road
  };
  // Bytes on their way to the disk at most: two seconds of raw images and scans.
  static constexpr std::size_t most_under_way = std::size_t{64} << 20;

  // Replaces the file. `raw`: with the images and scans, so that the whole graph can be replayed
  // from the log. Throws std::runtime_error naming it when it cannot be written, or when another
  // recorder, of any process, is writing it.
  explicit LogRecorder(const std::string& path, bool raw = false,
                       WhenBehind when_behind = WhenBehind::wait);
  ~LogRecorder() override;

  std::string_view name() const override { return "log"; }
  bool wants_raw() const override { return raw_; }

  // Waits until all that was sent is on the disk, or counted as unsent.
  void flush() override;

 private:
  class File;

  bool take(const Message& message) override;
  void write_batches(const std::stop_token& end);

  std::unique_ptr<File> file_;
  bool raw_;
  WhenBehind when_behind_;

  std::mutex mutex_;  // of what follows
  std::condition_variable_any changed_;
  LogBatch filling_;
  bool flushing_ = false;
  bool writing_ = false;
  std::int64_t events_ = 0;

  std::stop_source end_;
  runtime::Thread writer_;
};

}  // namespace maploop::vehicle
