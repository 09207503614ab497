#include "sensors/bag/mcap_reader.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "sensors/bag/mcap_format.h"

namespace maploop::sensors::bag {
namespace {

constexpr std::size_t record_head = 9;  // opcode, length
constexpr std::size_t footer_size = record_head + 20;

}  // namespace

McapReader::McapReader(const Opening& opening) : ChunkedReader(opening) {
  if (as_text(bytes_.at(0, mcap_magic.size())) != mcap_magic)
    throw FileError(file_, "not an MCAP file of version 0");
  bool indexed = false;
  try {
    indexed = read_summary();
  } catch (const Malformed& error) {
    add_damage(offset_, std::string("the index is damaged, so that all is read from front to "
                                    "back: ") +
                            error.what());
  }
  lacks_end_ = !indexed;
  indexed ? follow_index() : read_from(mcap_magic.size());
}

bool McapReader::read_summary() {
  const std::uint64_t size = bytes_.size();
  if (size < 2 * mcap_magic.size() + footer_size) return false;
  const std::uint64_t footer_at = offset_ = size - mcap_magic.size() - footer_size;
  const Bytes end = bytes_.at(footer_at, footer_size + mcap_magic.size());
  const Record record = split(end);
  if (record.op != mcap_op::footer || record.size != footer_size ||
      as_text(end.subspan(footer_size)) != mcap_magic)
    return false;  // the file was cut
  ByteCursor fields(record.data);
  const auto start = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();  // where the summary's own index starts
  const auto crc = fields.number<std::uint32_t>();
  if (start == 0) return false;
  if (start > footer_at) throw Malformed("it should start behind the end of the file");
  if (crc != 0 && !has_crc(start, footer_at + footer_size - sizeof crc, crc))
    throw Malformed("its checksum (CRC) is wrong");
  read_index(start, footer_at);
  return !chunks_.empty() && (stated_chunks_ == 0 || stated_chunks_ == chunks_.size());
}

bool McapReader::has_crc(std::uint64_t begin, std::uint64_t end, std::uint32_t crc) {
  std::uint32_t sum = 0;
  while (begin < end) {
    const Bytes part = bytes_.at(begin, std::min(input_limits::mebibyte, std::size_t{end - begin}));
    if (part.empty()) return false;
    sum = crc_of(part, sum);
    begin += part.size();
  }
  return sum == crc;
}

Record McapReader::split(Bytes bytes) const {
  if (bytes.size() < record_head) return {0, {}, {}, record_head};
  ByteCursor fields(bytes);
  const auto op = fields.number<std::uint8_t>();
  const auto length = std::min(fields.number<std::uint64_t>(),
                               std::numeric_limits<std::uint64_t>::max() - record_head);
  const Bytes rest = fields.rest();
  return {op, {}, rest.first(std::min<std::uint64_t>(length, rest.size())), record_head + length};
}

// Records that are not known are skipped, as the specification requires.
ChunkedReader::Use McapReader::use_of(std::uint8_t op) const {
  switch (op) {
    case 0:
      return Use::none;
    case mcap_op::schema:
    case mcap_op::channel:
    case mcap_op::message:
      return Use::inside_too;
    case mcap_op::chunk:
      return Use::chunk;
    case mcap_op::chunk_index:
    case mcap_op::statistics:
      return Use::alone;
    case mcap_op::data_end:
    case mcap_op::footer:
      return Use::end;
    default:
      return Use::skip;
  }
}

Chunk McapReader::chunk_of(const Record& record) const {
  ByteCursor fields(record.data);
  fields.bytes(2 * sizeof(std::uint64_t));  // times of the first and last message
  Chunk chunk;
  chunk.size = {fields.number<std::uint64_t>(), true};
  chunk.crc = fields.number<std::uint32_t>();
  chunk.compression = fields.text();
  const auto packed_size = fields.number<std::uint64_t>();
  const Bytes rest = fields.rest();
  chunk.cut = record.data.size() < record.size - record_head;
  if (packed_size > rest.size() && !chunk.cut) {
    throw Malformed("a chunk of " + std::to_string(packed_size) + " bytes is in a record with " +
                    std::to_string(rest.size()));
  }
  chunk.data = rest.first(std::min<std::uint64_t>(packed_size, rest.size()));
  return chunk;
}

void McapReader::take(const Record& record) {
  const ByteCursor fields(record.data);
  switch (record.op) {
    case mcap_op::schema:
      return take_schema(fields);
    case mcap_op::channel:
      return take_channel(fields);
    case mcap_op::message:
      return take_message(fields);
    case mcap_op::chunk_index:
      return take_chunk_index(fields);
    case mcap_op::statistics:
      return take_statistics(fields);
    default:
      return;
  }
}

void McapReader::take_schema(ByteCursor fields) {
  const auto id = fields.number<std::uint16_t>();
  if (schemas_.contains(id)) return;  // writers repeat them
  const std::string_view name = fields.text(), encoding = fields.text(), text = fields.text();
  schema_bytes_ += name.size() + text.size();
  if (schema_bytes_ > input_limits::table)
    throw Malformed("the types have more than " + std::to_string(input_limits::table) + " bytes");
  const bool binary = encoding == "protobuf" || encoding == "flatbuffer";
  schemas_[id] = {std::string(name), binary ? "" : std::string(text)};
}

void McapReader::take_channel(ByteCursor fields) {
  const auto id = fields.number<std::uint16_t>();
  if (knows(id)) return;  // writers repeat them
  const auto known = schemas_.find(fields.number<std::uint16_t>());
  const Schema schema = known == schemas_.end() ? Schema() : known->second;
  const std::string_view name = fields.text(), encoding = fields.text();
  add_channel(id, {std::string(name), ros1_type(schema.name), std::string(encoding), schema.text});
}

void McapReader::take_message(ByteCursor fields) {
  const auto channel = fields.number<std::uint16_t>();
  fields.number<std::uint32_t>();  // the publisher's count
  const auto logged = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();  // when it was published
  add_message(channel, logged, fields.rest());
}

void McapReader::take_chunk_index(ByteCursor fields) {
  ChunkPlace place;
  place.first = checked_time(fields.number<std::uint64_t>());
  place.last = checked_time(fields.number<std::uint64_t>());
  place.offset = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();  // size of the chunk
  for (ByteCursor offsets(fields.block()); !offsets.rest().empty();) {
    place.channels.push_back(offsets.number<std::uint16_t>());
    offsets.number<std::uint64_t>();  // where its messages are
  }
  add_chunk(std::move(place));
}

void McapReader::take_statistics(ByteCursor fields) {
  fields.bytes(8 + 2 + 4 + 4 + 4);  // numbers of messages, schemas, channels, attachments, metadata
  stated_chunks_ = fields.number<std::uint32_t>();
  fields.bytes(8 + 8);  // times of the first and last message
  for (ByteCursor counts(fields.block()); !counts.rest().empty();) {
    const auto channel = counts.number<std::uint16_t>();
    counts_[channel] += counts.number<std::uint64_t>();
  }
}

}  // namespace maploop::sensors::bag
