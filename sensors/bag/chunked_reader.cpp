#include "sensors/bag/chunked_reader.h"

#include <algorithm>
#include <utility>

#include "msgs/input_limits.h"

namespace maploop::sensors::bag {
namespace {

// A chunk's own fields come in addition to what it contains.
constexpr std::uint64_t largest_record = input_limits::chunk + input_limits::mebibyte;

void require_loaded(const Record& record) {
  if (record.size > largest_record) {
    throw Malformed("a record of " + std::to_string(record.size) + " bytes is larger than the " +
                    std::to_string(largest_record) + " that are expected");
  }
}

}  // namespace

ChunkedReader::ChunkedReader(const Opening& opening)
    : RecordingReader(opening), bytes_(opening.path) {}

// Records that are skipped are not loaded: an attachment may have any size.
Record ChunkedReader::record_at(std::uint64_t offset) {
  constexpr std::uint64_t usual_size = 4096;
  const std::uint64_t left = bytes_.size() - std::min(offset, bytes_.size());
  for (std::uint64_t need = std::min(usual_size, left);;) {
    const Bytes bytes = bytes_.at(offset, need);
    if (bytes.size() < need) throw Malformed("the disk does not deliver what is stored here");
    Record record = split(bytes);
    const bool whole = record.size <= need || need == left;
    if (whole || record.size > largest_record || (record.op != 0 && use_of(record.op) == Use::skip))
      return record;
    need = std::min(record.size, left);
  }
}

bool ChunkedReader::read_more() {
  if (indexed_) {
    if (next_chunk_ == chunks_.size()) return false;
    offset_ = chunks_[next_chunk_++].offset;
    const Record record = record_at(offset_);
    if (use_of(record.op) != Use::chunk)
      throw Malformed("the index names a chunk here, but there is none");
    read_chunk(record);
    return true;
  }
  if (position_ < bytes_.size()) {
    read_next_record();
    return true;
  }
  if (!std::exchange(lacks_end_, false)) return false;
  offset_ = bytes_.size();
  throw Malformed("the recording has no end: it was cut, or is still being written");
}

// Reads on behind the record even if it is damaged, where its size can be believed.
void ChunkedReader::read_next_record() {
  const bool lacked_end = std::exchange(lacks_end_, false);
  offset_ = std::exchange(position_, bytes_.size());
  const Record record = record_at(offset_);
  const Use use = use_of(record.op);
  if (use == Use::end) return;
  const bool cut = record.size > bytes_.size() - offset_;
  if (cut && use != Use::chunk) {
    throw Malformed("the file ends inside a record of at least " + std::to_string(record.size) +
                    " bytes");
  }
  if (use == Use::none)
    throw Malformed("there is no record here: what follows is not read, for its place is unknown");
  if (!cut) {
    position_ = offset_ + record.size;
    lacks_end_ = lacked_end;
  }
  if (use == Use::chunk) {
    read_chunk(record);
  } else if (use != Use::skip) {
    require_loaded(record);
    take(record);
  }
}

void ChunkedReader::read_index(std::uint64_t begin, std::uint64_t end) {
  for (offset_ = begin; offset_ < end;) {
    const Record record = record_at(offset_);
    if (record.size > end - offset_) throw Malformed("the index is cut");
    const Use use = use_of(record.op);
    if (use == Use::none) throw Malformed("there is no record here");
    if (use == Use::alone || use == Use::inside_too) {
      require_loaded(record);
      take(record);
    }
    offset_ += record.size;
  }
}

void ChunkedReader::follow_index() {
  // No chunk is read twice, whatever the index says.
  const auto by_offset = [](const auto& a, const auto& b) { return a.offset < b.offset; };
  const auto same_offset = [](const auto& a, const auto& b) { return a.offset == b.offset; };
  const auto by_time = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::stable_sort(chunks_.begin(), chunks_.end(), by_offset);
  chunks_.erase(std::unique(chunks_.begin(), chunks_.end(), same_offset), chunks_.end());
  std::erase_if(chunks_, [&](const ChunkPlace& place) { return !may_contain(place); });
  if (!selection_.as_written) std::stable_sort(chunks_.begin(), chunks_.end(), by_time);
  indexed_ = true;
}

bool ChunkedReader::may_contain(const ChunkPlace& place) const {
  if (place.last < selection_.begin) return false;
  const auto selected = [&](std::uint32_t channel) {
    const auto found = channels_.find(channel);
    return found == channels_.end() || found->second.selected;
  };
  return place.channels.empty() ||
         std::any_of(place.channels.begin(), place.channels.end(), selected);
}

void ChunkedReader::read_chunk(const Record& record) {
  require_loaded(record);
  const Chunk chunk = chunk_of(record);
  const Inflated inflated = inflate(chunk.compression, chunk.data, chunk.size, inflated_);
  if (chunk.cut) {
    add_damage(offset_, "the file ends inside a chunk: what it contains up to there is read");
  } else if (!inflated.error.empty()) {
    throw Malformed("a chunk is left out: " + inflated.error);
  } else if (chunk.crc != 0 && chunk.crc != crc_of(inflated.bytes)) {
    throw Malformed("a chunk is left out: its checksum (CRC) is wrong");
  }
  take_messages(chunk, inflated.bytes);
}

void ChunkedReader::take_messages(const Chunk& chunk, Bytes content) {
  std::size_t malformed = 0;
  std::string first;
  const auto note = [&](std::string reason) {
    if (malformed++ == 0) first = std::move(reason);
  };
  for (Bytes left = content; !left.empty();) {
    const Record record = split(left);
    if (record.size > left.size()) {
      if (!chunk.cut) note("a record of " + std::to_string(record.size) + " bytes is cut");
      break;
    }
    try {
      if (use_of(record.op) == Use::inside_too) take(record);
    } catch (const Malformed& error) {
      note(error.what());
    }
    left = left.subspan(record.size);
  }
  if (malformed > 0) {
    add_damage(offset_,
               std::to_string(malformed) + " records of this chunk are left out: " + first);
  }
  const auto earlier = [](const Waiting& a, const Waiting& b) { return a.received < b.received; };
  if (!selection_.as_written && !std::is_sorted(waiting_.begin(), waiting_.end(), earlier))
    std::stable_sort(waiting_.begin(), waiting_.end(), earlier);
}

void ChunkedReader::add_channel(std::uint32_t channel, const Topic& topic) {
  constexpr std::size_t most = std::size_t{1} << 16U;
  if (channels_.size() == most)
    throw Malformed("there are more than " + std::to_string(most) + " channels");
  channels_[channel] = {add_topic(topic), selects(topic)};
}

void ChunkedReader::add_chunk(ChunkPlace place) {
  if (place.last < place.first) throw Malformed("a chunk ends before it begins");
  chunks_.push_back(std::move(place));
}

void ChunkedReader::add_message(std::uint32_t channel, std::uint64_t nanoseconds, Bytes data) {
  const auto found = channels_.find(channel);
  if (found == channels_.end())
    throw Malformed("nothing states the topic of channel " + std::to_string(channel));
  if (!found->second.selected) return;
  const Time received = checked_time(nanoseconds);
  if (received >= selection_.begin) waiting_.push_back({received, found->second.topic, data});
}

std::optional<std::vector<TopicSummary>> ChunkedReader::index_summary() {
  if (!indexed_ || (counts_.empty() && !chunks_.empty())) return {};
  std::map<std::uint32_t, std::pair<Time, Time>> times;
  for (const ChunkPlace& place : chunks_) {
    for (const std::uint32_t channel : place.channels) {
      const auto [found, is_new] = times.try_emplace(channel, place.first, place.last);
      auto& [first, last] = found->second;
      first = std::min(first, place.first);
      last = std::max(last, place.last);
    }
  }
  std::vector<TopicSummary> topics;
  for (const auto& [id, channel] : channels_) {
    const auto [first, last] = times[id];
    topics.push_back({*channel.topic, counts_[id], first, last});
  }
  return topics;
}

}  // namespace maploop::sensors::bag
