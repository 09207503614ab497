#include "sensors/bag/ros1_bag_writer.h"

#include <algorithm>

#include "sensors/bag/compression.h"
#include "sensors/bag/ros1_bag_format.h"
#include "sensors/bag/written_bytes.h"

namespace maploop::sensors::bag {
namespace {

std::string field(std::string_view name, std::string_view value) {
  return text(std::string(name).append("=").append(value));
}

std::string time(std::uint64_t nanoseconds) {
  constexpr std::uint64_t second = 1'000'000'000;
  return number(static_cast<std::uint32_t>(nanoseconds / second)) +
         number(static_cast<std::uint32_t>(nanoseconds % second));
}

std::string record(std::uint8_t op, const std::string& fields, std::string_view data) {
  return text(field("op", number(op)) + fields) + text(data);
}

constexpr std::uint32_t version = 1;  // of the index

}  // namespace

Ros1BagWriter::Ros1BagWriter(Append append, std::string compression)
    : append_(std::move(append)), compression_(std::move(compression)) {
  this->append(head(0));
}

// Its size does not depend on the numbers.
std::string Ros1BagWriter::head(std::uint64_t index) const {
  constexpr std::size_t usual_size = 4096;
  const std::string fields =
      text(ros1_own_field) + field("op", number(bag_op::bag_header)) +
      field("index_pos", number(index)) + field("conn_count", number(connection_count_)) +
      field("chunk_count", number(static_cast<std::uint32_t>(chunks_.size())));
  return std::string(ros1_bag_line) + text(fields) +
         text(std::string(usual_size - fields.size(), ' '));
}

void Ros1BagWriter::append(const std::string& part) {
  append_(part);
  offset_ += part.size();
}

std::uint32_t Ros1BagWriter::add_connection(const Ros1Connection& c) {
  const std::uint32_t id = connection_count_++;
  // A static transform holds from the start for those who begin to listen later.
  const std::string latching = c.topic == "/tf_static" ? field("latching", "1") : "";
  const std::string all =
      record(bag_op::connection, field("conn", number(id)) + field("topic", c.topic),
             field("topic", c.topic) + field("type", c.type) + field("md5sum", c.md5) +
                 field("message_definition", c.definition) + latching);
  chunk_ += all;
  connections_ += all;
  return id;
}

void Ros1BagWriter::write(std::uint32_t connection, std::int64_t nanoseconds,
                          std::string_view data) {
  const auto stamp = static_cast<std::uint64_t>(nanoseconds);
  const bool is_first = in_chunk_.empty();
  first_ = is_first ? stamp : std::min(first_, stamp);
  last_ = is_first ? stamp : std::max(last_, stamp);
  in_chunk_[connection].emplace_back(stamp, static_cast<std::uint32_t>(chunk_.size()));
  chunk_ +=
      record(bag_op::message, field("conn", number(connection)) + field("time", time(stamp)), data);
}

void Ros1BagWriter::end_chunk() {
  if (in_chunk_.empty()) return;
  ChunkInfo info{first_, last_, offset_, {}};
  std::string part = record(bag_op::chunk,
                            field("compression", compression_) +
                                field("size", number(static_cast<std::uint32_t>(chunk_.size()))),
                            pack(compression_, chunk_));
  for (auto& [connection, entries] : in_chunk_) {
    const auto count = static_cast<std::uint32_t>(entries.size());
    info.counts[connection] = count;
    std::sort(entries.begin(), entries.end());  // readers search it
    std::string places;
    for (const auto& [stamp, place] : entries) places += time(stamp) + number(place);
    part += record(bag_op::index_data,
                   field("ver", number(version)) + field("conn", number(connection)) +
                       field("count", number(count)),
                   places);
  }
  append(part);
  chunks_.push_back(std::move(info));
  chunk_.clear();
  in_chunk_.clear();
}

std::string Ros1BagWriter::close() {
  end_chunk();
  const std::uint64_t index = offset_;
  std::string part = connections_;
  for (const ChunkInfo& chunk : chunks_) {
    std::string counts;
    for (const auto& [connection, count] : chunk.counts)
      counts += number(connection) + number(count);
    part +=
        record(bag_op::chunk_info,
               field("ver", number(version)) + field("chunk_pos", number(chunk.offset)) +
                   field("start_time", time(chunk.first)) + field("end_time", time(chunk.last)) +
                   field("count", number(static_cast<std::uint32_t>(chunk.counts.size()))),
               counts);
  }
  append(part);
  return head(index);
}

}  // namespace maploop::sensors::bag
