// This file reads the values of a message of ROS one after the other, in both of its encodings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "msgs/time.h"

namespace maploop::sensors {

// ros1 packs values without gaps in little endian. cdr (OMG DDS-XTypes 1.3, section 7.4.3, plain
// CDR of version 1) aligns each number to its size, counted from the end of a header of four bytes,
// which also states the order of bytes.
enum class RosEncoding : std::uint8_t { ros1, cdr };

// The texts and bytes that it returns are parts of the message. Each function throws
// std::invalid_argument if the message ends before the value does.
class RosCursor {
 public:
  // Throws std::invalid_argument if the header of cdr is of another form.
  RosCursor(std::span<const std::uint8_t> message, RosEncoding encoding);

  RosEncoding encoding() const { return encoding_; }

  // Reads a number: T is bool, or an integer or a floating-point number of 1 to 8 bytes.
  template <class T>
  T number();

  template <class T, std::size_t size>
  void numbers(T (&to)[size]);

  std::string_view text();

  // Reads the length of a sequence whose elements have at least `element` bytes each.
  std::size_t count(std::size_t element);

  std::span<const std::uint8_t> bytes(std::size_t count);
  std::span<const std::uint8_t> byte_sequence() { return bytes(count(1)); }

  // Reads seconds and nanoseconds since 1970. Throws std::invalid_argument if the nanoseconds are a
  // second or more.
  Time time();

 private:
  const std::uint8_t* take(std::size_t size);

  std::span<const std::uint8_t> message_;
  RosEncoding encoding_;
  bool swapped_ = false;
  std::size_t origin_ = 0;  // from which alignment counts
  std::size_t at_ = 0;
};

}  // namespace maploop::sensors
