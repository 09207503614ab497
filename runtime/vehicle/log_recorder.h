// Messages in a standard LCM log, readable by every LCM tool.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "runtime/vehicle/message_sink.h"

namespace maploop::vehicle {

// Events carry the data's time, so that a log of the same drive has the same bytes at any speed,
// but for DEADLINES and HEALTH.
class LogRecorder final : public MessageSink {
 public:
  // Replaces the file. `raw`: with the images and scans, so that the whole graph can be replayed
  // from the log. Throws std::runtime_error naming it when it cannot be written, or when another
  // recorder, of any process, is writing it.
  explicit LogRecorder(const std::string& path, bool raw = false);
  ~LogRecorder() override;

  std::string_view name() const override { return "log"; }
  bool wants_raw() const override { return raw_; }

 private:
  bool take(const Message& message) override;

  struct File;
  std::unique_ptr<File> file_;
  bool raw_;
  std::string channel_;
};

}  // namespace maploop::vehicle
