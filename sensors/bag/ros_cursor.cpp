#include "sensors/bag/ros_cursor.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>

namespace maploop::sensors {

static_assert(std::endian::native == std::endian::little, "ros1 is little endian");

RosCursor::RosCursor(std::span<const std::uint8_t> message, RosEncoding encoding)
    : message_(message), encoding_(encoding) {
  if (encoding == RosEncoding::ros1) return;
  constexpr std::size_t header_bytes = 4;
  const std::uint8_t* header = take(header_bytes);
  if (header[0] != 0 || header[1] > 1) {
    throw std::invalid_argument("its representation " + std::to_string(header[0]) + "," +
                                std::to_string(header[1]) + " is not plain CDR");
  }
  swapped_ = header[1] == 0;
  origin_ = header_bytes;
}

const std::uint8_t* RosCursor::take(std::size_t size) {
  if (size > message_.size() - at_) {
    throw std::invalid_argument("it ends within a value at byte " + std::to_string(at_));
  }
  const std::uint8_t* begin = message_.data() + at_;
  at_ += size;
  return begin;
}

template <class T>
T RosCursor::number() {
  if (encoding_ == RosEncoding::cdr) take((sizeof(T) - (at_ - origin_) % sizeof(T)) % sizeof(T));
  std::uint8_t raw[sizeof(T)];
  std::memcpy(raw, take(sizeof(T)), sizeof(T));
  if (swapped_) std::reverse(std::begin(raw), std::end(raw));
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

template <>
bool RosCursor::number<bool>() {
  return number<std::uint8_t>() != 0;
}

template std::int8_t RosCursor::number();
template std::uint8_t RosCursor::number();
template std::uint16_t RosCursor::number();
template std::int32_t RosCursor::number();
template std::uint32_t RosCursor::number();
template std::uint64_t RosCursor::number();
template double RosCursor::number();

template <class T, std::size_t size>
void RosCursor::numbers(T (&to)[size]) {
  for (T& value : to) value = number<T>();
}

template void RosCursor::numbers(std::uint8_t (&)[4]);
template void RosCursor::numbers(double (&)[3]);
template void RosCursor::numbers(double (&)[4]);
template void RosCursor::numbers(double (&)[9]);
template void RosCursor::numbers(double (&)[12]);
template void RosCursor::numbers(double (&)[36]);

std::span<const std::uint8_t> RosCursor::bytes(std::size_t count) {
  return {take(count), count};
}

std::size_t RosCursor::count(std::size_t element) {
  const std::size_t size = number<std::uint32_t>();
  if (size > (message_.size() - at_) / element) {
    throw std::invalid_argument("it ends within a sequence of " + std::to_string(size) +
                                " elements at byte " + std::to_string(at_));
  }
  return size;
}

std::string_view RosCursor::text() {
  const std::span<const std::uint8_t> all = byte_sequence();
  std::string_view text(reinterpret_cast<const char*>(all.data()), all.size());
  if (encoding_ == RosEncoding::cdr && text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

Time RosCursor::time() {
  const std::int64_t seconds = number<std::uint32_t>();
  const std::int64_t nanoseconds = number<std::uint32_t>();
  if (nanoseconds >= 1'000'000'000) {
    throw std::invalid_argument("its stamp has " + std::to_string(nanoseconds) + " nanoseconds");
  }
  return from_nanoseconds(seconds * 1'000'000'000 + nanoseconds);
}

}  // namespace maploop::sensors
