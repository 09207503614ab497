// Tests the reader on intact, damaged and malicious logs.
#include "msgs/lcm/log/log_reader.h"

#include <algorithm>
#include <random>
#include <stdexcept>

#include "tests/tools/log/small_log.h"

namespace maploop::lcm_log {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Reading {
  std::vector<TestEvent> events;
  std::vector<Damage> damages;
};

// Reads a whole log; each byte must be in exactly one event or one damage.
Reading read_all(const path& file) {
  LogReader reader(file, schema::own_schema());
  Reading all;
  std::uint64_t position = 0;
  for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
    if (item == LogReader::Item::event) {
      const LogEvent& e = reader.event();
      EXPECT_EQ(e.offset, position);
      position += header_bytes + e.channel.size() + e.data.size();
      all.events.push_back({std::string(e.channel), e.time_us, {e.data.begin(), e.data.end()}});
    } else {
      EXPECT_EQ(reader.damage().begin, position);
      EXPECT_FALSE(reader.damage().reason.empty());
      position = reader.damage().end;
      all.damages.push_back(reader.damage());
    }
  }
  EXPECT_EQ(reader.input().position(), position);
  return all;
}

class LogReaderTest : public LogToolsTest {
 protected:
  Reading read(const Bytes& bytes) const {
    write_bytes(out_, bytes);
    return read_all(out_);
  }

  // An event of unknown type with no event directly after it is lost too.
  bool is_unknown(std::size_t event) const {
    return schema::own_schema().find(schema::fingerprint_of(drive_[event].data)) == nullptr;
  }

  std::size_t random(std::size_t below) { return random_() % below; }

  const Bytes whole_ = read_bytes(log_);
  std::mt19937 random_{20110926};
};

TEST_F(LogReaderTest, WholeLogIsWhatLcmReads) {
  const Reading all = read_all(log_);
  EXPECT_TRUE(all.damages.empty());
  EXPECT_EQ(all.events, drive_);
  EXPECT_EQ(all.events, read_with_lcm(log_));
  write_compressed(out_, whole_);
  EXPECT_EQ(read_all(out_).events, drive_);
}

TEST_F(LogReaderTest, CutAtEveryByte) {
  std::size_t complete = 0;
  for (std::size_t size = 0; size < whole_.size(); ++size) {
    while (offsets_[complete + 1] <= size) ++complete;
    const Reading all = read({whole_.begin(), whole_.begin() + static_cast<std::ptrdiff_t>(size)});
    ASSERT_EQ(all.events, without(complete, drive_.size() - 1)) << size;
    ASSERT_EQ(all.damages.size(), size == offsets_[complete] ? 0U : 1U) << size;
  }
}

// A wrong bit in the sync word or a length loses its own event only; a wrong bit in the number, the
// time or the channel's name leaves the event readable.
TEST_F(LogReaderTest, EverySingleBitOfEveryHeader) {
  for (std::size_t event = 0; event < drive_.size(); ++event) {
    for (std::size_t bit = 0; bit < 8 * header_bytes; ++bit) {
      const std::size_t byte = bit / 8;
      Bytes bytes = whole_;
      bytes[offsets_[event] + byte] ^= static_cast<std::uint8_t>(1U << bit % 8);
      const Reading all = read(bytes);
      if (byte >= 4 && byte < 20) {
        ASSERT_TRUE(all.damages.empty());
        ASSERT_EQ(all.events.size(), drive_.size());
        ASSERT_EQ(all.events[event].data, drive_[event].data);
      } else {
        ASSERT_EQ(all.events, without(event, event)) << "event " << event << " bit " << bit;
        ASSERT_EQ(all.damages.size(), 1U);
        ASSERT_EQ(all.damages[0].begin, offsets_[event]);
        ASSERT_EQ(all.damages[0].end, offsets_[event + 1]);
      }
    }
  }
}

TEST_F(LogReaderTest, LengthsOverwrittenWithAnything) {
  for (int round = 0; round < 4000; ++round) {
    Bytes bytes = whole_;
    const std::size_t event = random(drive_.size());
    const std::size_t field = offsets_[event] + (random(2) == 0 ? 20 : 24);
    const auto value = random(random(2) == 0 ? 2000 : 1U << 31);
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[field + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
    }
    if (bytes == whole_) continue;
    ASSERT_EQ(read(bytes).events, without(event, event)) << "event " << event << ": " << value;
  }
}

TEST_F(LogReaderTest, GarbageBetweenEventsTakesNoneWithIt) {
  for (int round = 0; round < 1000; ++round) {
    Bytes bytes = whole_;
    const std::size_t event = random(drive_.size() + 1);
    Bytes garbage(1 + random(600));
    for (auto& byte : garbage) byte = static_cast<std::uint8_t>(random_());
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(offsets_[event]), garbage.begin(),
                 garbage.end());
    const Reading all = read(bytes);
    if (event > 0 && is_unknown(event - 1)) {
      ASSERT_GE(all.events.size(), drive_.size() - 1);
    } else {
      ASSERT_EQ(all.events, drive_) << "before event " << event;
      ASSERT_EQ(all.damages.size(), 1U);
      ASSERT_EQ(all.damages[0].bytes(), garbage.size());
    }
  }
}

TEST_F(LogReaderTest, OverwrittenPieceTakesOnlyWhatItTouches) {
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes = whole_;
    const std::size_t begin = random(bytes.size());
    const std::size_t end = std::min(bytes.size(), begin + 1 + random(2000));
    for (std::size_t i = begin; i < end; ++i) bytes[i] = static_cast<std::uint8_t>(random_());
    const Reading all = read(bytes);
    for (std::size_t i = 0; i < drive_.size(); ++i) {
      const bool touched = begin < offsets_[i + 1] && end > offsets_[i];
      if (touched || (begin == offsets_[i + 1] && is_unknown(i))) continue;
      ASSERT_TRUE(std::find(all.events.begin(), all.events.end(), drive_[i]) != all.events.end())
          << "event " << i << " of bytes " << begin << " to " << end;
    }
  }
}

TEST_F(LogReaderTest, BitsAnywhereNeverCrash) {
  for (int round = 0; round < 3000; ++round) {
    Bytes bytes = whole_;
    for (auto n = 1 + random(40); n > 0; --n) {
      bytes[random(bytes.size())] ^= static_cast<std::uint8_t>(1U << random(8));
    }
    read(bytes);
  }
}

TEST_F(LogReaderTest, LogInsideAMessageIsData) {
  for (const std::size_t event : {std::size_t{7}, drive_.size() - 1}) {
    auto events = drive_;
    events[event].data = whole_;
    record(log_, events);
    EXPECT_EQ(read_all(log_).events, events) << event;
  }
}

TEST_F(LogReaderTest, DamagedCompressedLogGivesWhatComesBefore) {
  write_compressed(out_, whole_);
  Bytes bytes = read_bytes(out_);
  bytes.erase(bytes.end() - 12, bytes.end());
  const Reading all = read(bytes);
  ASSERT_FALSE(all.damages.empty());
  EXPECT_NE(all.damages.back().reason.find("compressed"), std::string::npos);
  ASSERT_LE(all.events.size(), drive_.size());
  EXPECT_TRUE(std::equal(all.events.begin(), all.events.end(), drive_.begin()));
}

// Each header declares the most data, which begin in the next header: the reader must not spend
// time or memory on them.
TEST_F(LogReaderTest, HeadersThatPromiseTheMost) {
  LogHeader header{.sync = sync_word, .channel_bytes = 999, .data_bytes = maximum_data_bytes};
  EXPECT_FALSE(implausible(header));
  Bytes bytes(20'000 * header_bytes);
  for (std::size_t at = 0; at < bytes.size(); at += header_bytes, ++header.number) {
    write_header(header, std::span<std::uint8_t, header_bytes>(bytes.data() + at, header_bytes));
  }
  const Reading all = read(bytes);
  EXPECT_TRUE(all.events.empty());
  EXPECT_EQ(all.damages.size(), 1U);
  ++header.data_bytes;
  EXPECT_TRUE(implausible(header));
}

TEST_F(LogReaderTest, NothingButSyncWords) {
  Bytes bytes;
  for (int i = 0; i < 100'000; ++i) bytes.insert(bytes.end(), {0xED, 0xA1, 0xDA, 0x01});
  EXPECT_EQ(read(bytes).damages.size(), 1U);
}

TEST_F(LogReaderTest, NamesWhatItCannotOpen) {
  for (const path& file : {folder_.path() / "missing.lcmlog", folder_.path()}) {
    EXPECT_TRUE(contains(error_of<std::runtime_error>([&] { LogReader(file, types_); }), file));
  }
}

TEST(LogReaderRealData, LogsOfAGoKartAreWhatLcmReads) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const char* name : {"vlp16_and_wheels.lcm", "vlp16_position.lcm"}) {
    const auto file = maploop::testing::real_data() / "lcm" / name;
    const Reading all = read_all(file);
    EXPECT_TRUE(all.damages.empty());
    EXPECT_EQ(all.events, read_with_lcm(file));
    EXPECT_GE(all.events.size(), 11U);
  }
}

}  // namespace
}  // namespace maploop::lcm_log
