// A MessageSink is a destination of encoded messages: the bus, a log, or a hash.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "msgs/diagnostics.h"
#include "msgs/time.h"

namespace maploop::vehicle {

struct Message {
  std::string_view channel;
  Time time;                           // data time at which the content became available
  std::span<const std::uint8_t> data;  // LCM encoding
  bool from_data;                      // false for messages about this run: DEADLINES, HEALTH
};

// Only the publisher thread sends, except that a LogRecorder takes messages from any thread; any
// thread may read the name and the counts.
class MessageSink {
 public:
  virtual ~MessageSink() = default;
  virtual std::string_view name() const = 0;
  // Returns whether the sink also takes raw images and scans, some 30 MB/s.
  virtual bool wants_raw() const { return false; }

  // Returns whether the sink takes the pictures that are made for viewers (PREVIEW).
  virtual bool wants_preview() const { return false; }

  void send(const Message& message) {
    std::atomic<std::uint64_t>& count = take(message) ? sent_ : unsent_;
    count.fetch_add(1, std::memory_order_relaxed);
  }

  // Waits until every message sent is written or counted as unsent. Only the publisher thread calls
  // this.
  virtual void flush() {}

  OutputHealth health() const {
    return {std::string(name()), sent_.load(std::memory_order_relaxed),
            unsent_.load(std::memory_order_relaxed)};
  }

 protected:
  // Counts `messages` as unsent instead of sent, because they could not be written after all.
  void unsend(std::uint64_t messages) {
    sent_.fetch_sub(messages, std::memory_order_relaxed);
    unsent_.fetch_add(messages, std::memory_order_relaxed);
  }

 private:
  // Returns false if the message could not be sent or written; the next one is tried again.
  virtual bool take(const Message& message) = 0;

  std::atomic<std::uint64_t> sent_{0};
  std::atomic<std::uint64_t> unsent_{0};
};

}  // namespace maploop::vehicle
