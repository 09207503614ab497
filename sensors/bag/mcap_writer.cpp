#include "sensors/bag/mcap_writer.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "sensors/bag/compression.h"
#include "sensors/bag/mcap_format.h"
#include "sensors/bag/written_bytes.h"

namespace maploop::sensors::bag {
namespace {

constexpr std::string_view zstd = "zstd";
constexpr std::uint64_t footer_bytes = 20;

void append_record(std::string& to, std::uint8_t op, std::string_view fields,
                   std::string_view data = {}) {
  to += static_cast<char>(op);
  to += number(std::uint64_t{fields.size() + data.size()});
  to += fields;
  to += data;
}

std::uint32_t crc(std::string_view bytes) {
  return crc_of({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace

std::string McapWriter::head() const {
  if (offset_ > 0) return {};
  std::string head(mcap_magic);
  append_record(head, mcap_op::header, text(mcap_profile) + text("maploop"));
  return head;
}

bool McapWriter::append_part(const std::string& part) {
  const std::string all = head() + part;
  if (!append_(all)) return false;
  offset_ += all.size();
  return true;
}

std::uint16_t McapWriter::add_channel(const McapChannel& c) {
  const auto id = static_cast<std::uint16_t>(counts_.size() + 1);
  if (id == std::numeric_limits<std::uint16_t>::max())
    throw std::runtime_error("an MCAP file has at most 65535 channels");
  std::uint16_t schema = 0;
  std::string records;
  if (!c.schema_name.empty()) {
    const auto next = static_cast<std::uint16_t>(schemas_.size() + 1);
    const auto [known, is_new] = schemas_.try_emplace(c.schema_encoding + c.schema_name, next);
    schema = known->second;
    if (is_new) {
      append_record(
          records, mcap_op::schema,
          number(schema) + text(c.schema_name) + text(c.schema_encoding) + text(c.schema));
    }
  }
  append_record(records, mcap_op::channel,
                number(id) + number(schema) + text(c.topic) + text(c.encoding) +
                    number(std::uint32_t{0}));  // no metadata
  counts_[id] = 0;
  sequences_.push_back(0);
  chunk_ += records;
  new_in_chunk_ += records;
  declared_ += records;
  return id;
}

void McapWriter::write(std::uint16_t channel, std::int64_t nanoseconds, std::string_view data) {
  const auto time = static_cast<std::uint64_t>(nanoseconds);
  const bool is_first = in_chunk_.empty();
  first_ = is_first ? time : std::min(first_, time);
  last_ = is_first ? time : std::max(last_, time);
  in_chunk_[channel].emplace_back(time, chunk_.size());
  append_record(
      chunk_, mcap_op::message,
      number(channel) + number(sequences_.at(channel - 1U)++) + number(time) + number(time), data);
}

bool McapWriter::end_chunk() {
  if (in_chunk_.empty()) return true;
  const std::string packed = pack(zstd, chunk_);
  std::string part;
  append_record(part, mcap_op::chunk,
                number(first_) + number(last_) + number(std::uint64_t{chunk_.size()}) +
                    number(crc(chunk_)) + text(zstd) + number(std::uint64_t{packed.size()}),
                packed);
  Index index{first_, last_, 0, part.size(), {}, 0, packed.size(), chunk_.size()};
  for (const auto& [channel, entries] : in_chunk_) {
    index.channels[channel] = part.size();
    std::string list;
    for (const auto& [time, at] : entries) list += number(time) + number(at);
    append_record(part, mcap_op::message_index, number(channel) + text(list));
  }
  index.indexes_size = part.size() - index.size;
  const bool written = append_part(part);
  if (written) {
    index.offset = offset_ - part.size();
    for (auto& [channel, place] : index.channels) place += index.offset;
    for (const auto& [channel, entries] : in_chunk_) {
      counts_[channel] += entries.size();
      messages_ += entries.size();
    }
    chunks_.push_back(std::move(index));
    new_in_chunk_.clear();
  }
  chunk_ = new_in_chunk_;  // what a lost chunk stated is stated again
  in_chunk_.clear();
  return written;
}

std::string McapWriter::summary() const {
  std::uint64_t first = chunks_.empty() ? 0 : chunks_.front().first, last = 0;
  std::string records = declared_, counts;
  for (const auto& [channel, count] : counts_) counts += number(channel) + number(count);
  for (const Index& c : chunks_) {
    first = std::min(first, c.first);
    last = std::max(last, c.last);
    std::string places;
    for (const auto& [channel, place] : c.channels) places += number(channel) + number(place);
    append_record(records, mcap_op::chunk_index,
                  number(c.first) + number(c.last) + number(c.offset) + number(c.size) +
                      text(places) + number(c.indexes_size) + text(zstd) + number(c.packed_size) +
                      number(c.plain_size));
  }
  append_record(records, mcap_op::statistics,
                number(messages_) + number(static_cast<std::uint16_t>(schemas_.size())) +
                    number(static_cast<std::uint32_t>(counts_.size())) + number(std::uint32_t{0}) +
                    number(std::uint32_t{0}) + number(static_cast<std::uint32_t>(chunks_.size())) +
                    number(first) + number(last) + text(counts));
  return records;
}

bool McapWriter::close() {
  const bool whole = end_chunk();
  std::string part;
  append_record(part, mcap_op::data_end, number(std::uint32_t{0}));
  const std::uint64_t summary_start = offset_ + head().size() + part.size();
  std::string end = summary();
  end += static_cast<char>(mcap_op::footer);
  end += number(footer_bytes) + number(summary_start) + number(std::uint64_t{0});
  end += number(crc(end));
  part += end;
  part += mcap_magic;
  return append_part(part) && whole;
}

}  // namespace maploop::sensors::bag
