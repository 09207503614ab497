// Where encoded messages go: the bus, a log, a hash.
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
  Time time;                           // of the data: when it became available
  std::span<const std::uint8_t> data;  // LCM encoding
  bool from_data;                      // false for what speaks of this run: DEADLINES, HEALTH
};

// The publisher thread sends; any thread may read the name and the counts.
class MessageSink {
 public:
  virtual ~MessageSink() = default;
  virtual std::string_view name() const = 0;
  // Whether it takes raw images and scans too, some 30 MB/s.
  virtual bool wants_raw() const { return false; }

  // Whether people look on: pictures for them (PREVIEW).
  virtual bool wants_preview() const { return false; }

  void send(const Message& message) {
    std::atomic<std::uint64_t>& count = take(message) ? sent_ : unsent_;
    count.fetch_add(1, std::memory_order_relaxed);
  }

  // Waits until what was sent is out, or counted as unsent. The publisher's thread.
  virtual void flush() {}

  OutputHealth health() const {
    return {std::string(name()), sent_.load(std::memory_order_relaxed),
            unsent_.load(std::memory_order_relaxed)};
  }

 protected:
  // What was sent a while ago could not be written after all.
  void unsend(std::uint64_t messages) {
    sent_.fetch_sub(messages, std::memory_order_relaxed);
    unsent_.fetch_add(messages, std::memory_order_relaxed);
  }

 private:
  // False where the message could not be sent or written; the next one is tried again.
  virtual bool take(const Message& message) = 0;

  std::atomic<std::uint64_t> sent_{0};
  std::atomic<std::uint64_t> unsent_{0};
};

}  // namespace maploop::vehicle
