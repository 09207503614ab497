#include "sensors/bag/ros1_bag_reader.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "msgs/input_file.h"
#include "sensors/bag/ros1_bag_format.h"

namespace maploop::sensors::bag {
namespace {

// Returns the value of the field "name=value"; nothing if there is none. Each follows its length.
std::optional<Bytes> find_field(Bytes fields, std::string_view name) {
  while (fields.size() >= sizeof(std::uint32_t)) {
    const std::uint32_t size = ByteCursor(fields).number<std::uint32_t>();
    fields = fields.subspan(sizeof size);
    if (size > fields.size()) break;
    const Bytes field = fields.first(size);
    if (size > name.size() && field[name.size()] == '=' && as_text(field).starts_with(name))
      return field.subspan(name.size() + 1);
    fields = fields.subspan(size);
  }
  return {};
}

Bytes field_of(Bytes fields, std::string_view name) {
  const auto value = find_field(fields, name);
  if (!value) throw Malformed("a record without the field '" + std::string(name) + "'");
  return *value;
}

template <class Number>
Number number_of(Bytes fields, std::string_view name) {
  return ByteCursor(field_of(fields, name)).number<Number>();
}

// Times are seconds and nanoseconds since 1970.
std::uint64_t time_of(Bytes fields, std::string_view name) {
  ByteCursor value(field_of(fields, name));
  const std::uint64_t seconds = value.number<std::uint32_t>();
  return seconds * 1'000'000'000 + value.number<std::uint32_t>();
}

}  // namespace

Ros1BagReader::Ros1BagReader(const Opening& opening) : ChunkedReader(opening) {
  if (const auto line = as_text(bytes_.at(0, ros1_bag_line.size())); line != ros1_bag_line)
    throw FileError(file_, "not a ROS bag of version 2.0: 'rosbag fix' converts older ones");
  offset_ = ros1_bag_line.size();
  read_from(offset_);
  try {
    const Record head = record_at(offset_);
    if (head.op != bag_op::bag_header) throw Malformed("the bag's own record is not there");
    read_from(offset_ + head.size);
    read_bag_index(head);
    follow_index();
  } catch (const Malformed& error) {
    add_damage(offset_, std::string("the index cannot be used, so that all is read from front to "
                                    "back: ") +
                            error.what());
  }
}

void Ros1BagReader::read_bag_index(const Record& head) {
  const auto index = number_of<std::uint64_t>(head.fields, "index_pos");
  const auto stated = number_of<std::uint32_t>(head.fields, "chunk_count");
  if (index == 0) throw Malformed("the bag was not closed");
  if (index > bytes_.size()) throw Malformed("the file is cut before it");
  read_index(index, bytes_.size());
  if (chunks_.size() != stated) {
    throw Malformed("it has " + std::to_string(chunks_.size()) + " of " + std::to_string(stated) +
                    " chunks");
  }
}

Record Ros1BagReader::split(Bytes bytes) const {
  constexpr std::uint64_t lengths = 2 * sizeof(std::uint32_t);  // of the fields and of the data
  if (bytes.size() < lengths) return {0, {}, {}, lengths};
  ByteCursor cursor(bytes);
  const std::uint64_t fields_size = cursor.number<std::uint32_t>();
  if (bytes.size() < lengths + fields_size) return {0, {}, {}, lengths + fields_size};
  const Bytes fields = cursor.bytes(fields_size);
  const std::uint64_t data_size = cursor.number<std::uint32_t>();
  const Bytes rest = cursor.rest();
  const auto op = find_field(fields, "op");
  return {op && op->size() == 1 ? op->front() : std::uint8_t{0}, fields,
          rest.first(std::min<std::uint64_t>(data_size, rest.size())),
          lengths + fields_size + data_size};
}

ChunkedReader::Use Ros1BagReader::use_of(std::uint8_t op) const {
  switch (op) {
    case bag_op::message:
    case bag_op::connection:
      return Use::inside_too;
    case bag_op::chunk:
      return Use::chunk;
    case bag_op::chunk_info:
      return Use::alone;
    case bag_op::bag_header:
    case bag_op::index_data:
      return Use::skip;
    default:
      return Use::none;
  }
}

Chunk Ros1BagReader::chunk_of(const Record& record) const {
  Chunk chunk;
  chunk.compression = as_text(field_of(record.fields, "compression"));
  // Some writers state the size wrongly; Python's rosbag does not look at it.
  chunk.size = {number_of<std::uint32_t>(record.fields, "size"), false};
  chunk.data = record.data;
  chunk.cut = record.data.size() + record.fields.size() + 2 * sizeof(std::uint32_t) < record.size;
  return chunk;
}

void Ros1BagReader::take(const Record& record) {
  if (record.op == bag_op::connection) return take_connection(record);
  if (record.op == bag_op::chunk_info) return take_chunk_info(record);
  add_message(number_of<std::uint32_t>(record.fields, "conn"), time_of(record.fields, "time"),
              record.data);
}

void Ros1BagReader::take_connection(const Record& record) {
  const auto id = number_of<std::uint32_t>(record.fields, "conn");
  if (knows(id)) return;  // the index repeats those of the chunks
  add_channel(id, {std::string(as_text(field_of(record.fields, "topic"))),
                   std::string(as_text(field_of(record.data, "type"))), "ros1",
                   std::string(as_text(field_of(record.data, "message_definition")))});
}

void Ros1BagReader::take_chunk_info(const Record& record) {
  ChunkPlace place;
  place.offset = number_of<std::uint64_t>(record.fields, "chunk_pos");
  place.first = checked_time(time_of(record.fields, "start_time"));
  place.last = checked_time(time_of(record.fields, "end_time"));
  for (ByteCursor counts(record.data); !counts.rest().empty();) {
    place.channels.push_back(counts.number<std::uint32_t>());
    counts_[place.channels.back()] += counts.number<std::uint32_t>();
  }
  add_chunk(std::move(place));
}

}  // namespace maploop::sensors::bag
