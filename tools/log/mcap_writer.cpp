#include "tools/log/mcap_writer.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace maploop::lcm_log {
namespace {

static_assert(std::endian::native == std::endian::little, "MCAP is little endian");

constexpr std::string_view magic = "\x89MCAP0\r\n";
constexpr std::size_t chunk_bytes = std::size_t{1} << 20U;

namespace mcap_op {
constexpr char header = 0x01, footer = 0x02, schema = 0x03, channel = 0x04, message = 0x05,
               chunk = 0x06, message_index = 0x07, chunk_index = 0x08, statistics = 0x0b,
               data_end = 0x0f;
}  // namespace mcap_op

template <class Number>
std::string number(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string text(std::string_view value) {
  return number(static_cast<std::uint32_t>(value.size())) + std::string(value);
}

std::string record(char op, const std::string& content) {
  return op + number(std::uint64_t{content.size()}) + content;
}

std::string zstd(const std::string& plain) {
  std::string packed(ZSTD_compressBound(plain.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size) != 0U) throw std::runtime_error("zstd: cannot compress a chunk");
  packed.resize(size);
  return packed;
}

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& file) : file_(file) {
  put(magic);
  put(record(mcap_op::header, text("") + text("maploop")));
}

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes);
  offset_ += bytes.size();
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& schema_name,
                                      const std::string& json_schema) {
  const auto next_schema = static_cast<std::uint16_t>(schemas_.size() + 1);
  const auto [schema, is_new] = schemas_.try_emplace(schema_name, next_schema);
  std::string records;
  if (is_new) {
    records = record(mcap_op::schema, number(schema->second) + text(schema_name) +
                                          text("jsonschema") + text(json_schema));
  }
  const auto channel = static_cast<std::uint16_t>(counts_.size() + 1);
  counts_[channel] = 0;
  records += record(mcap_op::channel, number(channel) + number(schema->second) + text(topic) +
                                          text("json") + number(std::uint32_t{0}));
  chunk_ += records;
  declared_ += records;
  return channel;
}

void McapWriter::write(std::uint16_t channel, std::int64_t nanoseconds, std::string_view json) {
  const auto time = static_cast<std::uint64_t>(nanoseconds);
  const bool is_first = in_chunk_.empty();
  first_ = is_first ? time : std::min(first_, time);
  last_ = is_first ? time : std::max(last_, time);
  in_chunk_[channel].emplace_back(time, chunk_.size());
  const auto sequence = static_cast<std::uint32_t>(counts_.at(channel)++);
  chunk_ += record(mcap_op::message, number(channel) + number(sequence) + number(time) +
                                         number(time) + std::string(json));
  ++messages_;
  if (chunk_.size() >= chunk_bytes) flush_chunk();
}

void McapWriter::flush_chunk() {
  if (in_chunk_.empty()) return;
  const std::string packed = zstd(chunk_);
  Index index{first_, last_, offset_, 0, {}, 0, packed.size(), chunk_.size()};
  put(record(mcap_op::chunk, number(first_) + number(last_) + number(std::uint64_t{chunk_.size()}) +
                                 number(crc_of(chunk_)) + text("zstd") +
                                 number(std::uint64_t{packed.size()}) + packed));
  index.size = offset_ - index.offset;
  const std::uint64_t indexes = offset_;
  for (const auto& [channel, entries] : in_chunk_) {
    index.channels[channel] = offset_;
    std::string list;
    for (const auto& [time, at] : entries) list += number(time) + number(at);
    put(record(mcap_op::message_index, number(channel) + text(list)));
  }
  index.indexes_size = offset_ - indexes;
  whole_first_ = chunks_.empty() ? first_ : std::min(whole_first_, first_);
  whole_last_ = std::max(whole_last_, last_);
  chunks_.push_back(std::move(index));
  chunk_.clear();
  in_chunk_.clear();
}

std::string McapWriter::summary() const {
  std::string records = declared_;
  std::string counts;
  for (const auto& [channel, count] : counts_) counts += number(channel) + number(count);
  records +=
      record(mcap_op::statistics,
             number(messages_) + number(static_cast<std::uint16_t>(schemas_.size())) +
                 number(static_cast<std::uint32_t>(counts_.size())) + number(std::uint32_t{0}) +
                 number(std::uint32_t{0}) + number(static_cast<std::uint32_t>(chunks_.size())) +
                 number(whole_first_) + number(whole_last_) + text(counts));
  for (const Index& c : chunks_) {
    std::string places;
    for (const auto& [channel, place] : c.channels) places += number(channel) + number(place);
    records += record(mcap_op::chunk_index, number(c.first) + number(c.last) + number(c.offset) +
                                                number(c.size) + text(places) +
                                                number(c.indexes_size) + text("zstd") +
                                                number(c.packed_size) + number(c.plain_size));
  }
  return records;
}

void McapWriter::close() {
  flush_chunk();
  put(record(mcap_op::data_end, number(std::uint32_t{0})));
  const std::uint64_t summary_start = offset_;
  const std::string all = summary();
  put(all);
  const std::string footer = mcap_op::footer + number(std::uint64_t{20}) + number(summary_start) +
                             number(std::uint64_t{0});
  put(footer + number(crc_of(all + footer)));
  put(magic);
  file_.keep();
}

}  // namespace maploop::lcm_log
