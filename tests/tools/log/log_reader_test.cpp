// Tests the reader on intact, damaged and malicious logs.
#include "msgs/lcm/log/log_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "tests/support/real_data.h"
#include "tests/tools/log/small_log.h"
#include "tools/log/log_types.h"

namespace maploop::lcm_log {
namespace {

using Bytes = std::vector<std::uint8_t>;

const schema::Schema& types() {
  static const schema::Schema schema = load_types({});
  return schema;
}

struct Reading {
  std::vector<TestEvent> events;
  std::vector<std::int64_t> numbers;
  std::vector<Damage> damages;
};

// Reads a whole log; each byte must be in exactly one event or one damage.
Reading read_all(const std::filesystem::path& file, const LogLimits& limits = {}) {
  LogReader reader(file, types(), limits);
  Reading all;
  std::uint64_t position = 0;
  for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
    if (item == LogReader::Item::event) {
      const LogEvent& e = reader.event();
      EXPECT_EQ(e.offset, position);
      position += kHeaderBytes + e.channel.size() + e.data.size();
      all.events.push_back({std::string(e.channel), e.time_us, {e.data.begin(), e.data.end()}});
      all.numbers.push_back(e.number);
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

class LogReaderTest : public ::testing::Test {
 protected:
  LogReaderTest() { record(file_, drive_); }

  Reading read(const Bytes& bytes) {
    write_bytes(damaged_, bytes);
    return read_all(damaged_);
  }

  // Returns the whole drive without events first..last.
  std::vector<TestEvent> without(std::size_t first, std::size_t last) const {
    auto events = drive_;
    events.erase(events.begin() + static_cast<std::ptrdiff_t>(first),
                 events.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    return events;
  }

  const maploop::testing::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "whole.lcmlog";
  const std::filesystem::path damaged_ = folder_.path() / "damaged.lcmlog";
  const std::vector<TestEvent> drive_ = small_drive();
  const std::vector<std::size_t> offsets_ = event_offsets(drive_);
};

TEST_F(LogReaderTest, WholeLogIsWhatLcmReads) {
  const Reading all = read_all(file_);
  EXPECT_TRUE(all.damages.empty());
  EXPECT_EQ(all.events, drive_);
  EXPECT_EQ(all.events, read_with_lcm(file_));
}

TEST_F(LogReaderTest, CompressedLogIsTheSame) {
  const auto compressed = folder_.path() / "whole.lcmlog.gz";
  write_compressed(compressed, read_bytes(file_));
  EXPECT_EQ(read_all(compressed).events, drive_);
}

TEST_F(LogReaderTest, EmptyLogHasNoEventAndNoDamage) {
  const Reading all = read({});
  EXPECT_TRUE(all.events.empty());
  EXPECT_TRUE(all.damages.empty());
}

TEST_F(LogReaderTest, CutAtEveryByte) {
  const Bytes whole = read_bytes(file_);
  std::size_t complete = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    while (offsets_[complete + 1] <= size) ++complete;
    const Reading all = read({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    ASSERT_EQ(all.events,
              std::vector<TestEvent>(drive_.begin(),
                                     drive_.begin() + static_cast<std::ptrdiff_t>(complete)))
        << size;
    ASSERT_EQ(all.damages.size(), size == offsets_[complete] ? 0U : 1U) << size;
  }
}

// A wrong bit in the sync word or a length loses its own event only; a wrong bit in the number, the
// time or the channel's name leaves the event readable.
TEST_F(LogReaderTest, EverySingleBitOfEveryHeader) {
  const Bytes whole = read_bytes(file_);
  for (std::size_t event = 0; event < drive_.size(); ++event) {
    for (std::size_t byte = 0; byte < kHeaderBytes; ++byte) {
      for (int bit = 0; bit < 8; ++bit) {
        Bytes bytes = whole;
        bytes[offsets_[event] + byte] ^= static_cast<std::uint8_t>(1 << bit);
        const Reading all = read(bytes);
        if (byte >= 4 && byte < 20) {
          ASSERT_TRUE(all.damages.empty());
          ASSERT_EQ(all.events.size(), drive_.size());
          ASSERT_EQ(all.events[event].data, drive_[event].data);
        } else {
          ASSERT_EQ(all.events, without(event, event))
              << "event " << event << " byte " << byte << " bit " << bit;
          ASSERT_EQ(all.damages.size(), 1U);
          ASSERT_EQ(all.damages[0].begin, offsets_[event]);
          ASSERT_EQ(all.damages[0].end, offsets_[event + 1]);
        }
      }
    }
  }
}

TEST_F(LogReaderTest, LengthsOverwrittenWithAnything) {
  const Bytes whole = read_bytes(file_);
  std::mt19937 random(20110926);
  for (int round = 0; round < 4000; ++round) {
    Bytes bytes = whole;
    const std::size_t event = random() % drive_.size();
    const std::size_t field = offsets_[event] + (random() % 2 == 0 ? 20 : 24);
    const auto value = random() % (random() % 2 == 0 ? 2000 : 1U << 31);
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[field + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
    }
    if (bytes == whole) continue;
    ASSERT_EQ(read(bytes).events, without(event, event)) << "event " << event << ": " << value;
  }
}

TEST_F(LogReaderTest, GarbageBetweenEventsTakesNoneWithIt) {
  const Bytes whole = read_bytes(file_);
  std::mt19937 random(20110926);
  for (int round = 0; round < 1000; ++round) {
    Bytes bytes = whole;
    const std::size_t event = random() % (drive_.size() + 1);
    Bytes garbage(1 + random() % 600);
    for (auto& byte : garbage) byte = static_cast<std::uint8_t>(random());
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(offsets_[event]), garbage.begin(),
                 garbage.end());
    const Reading all = read(bytes);
    // An event of unknown type with no event directly after it is doubtful if no earlier event on
    // its channel was similar.
    if (event == 5 || event == 6) {
      ASSERT_GE(all.events.size(), drive_.size() - 1);
    } else {
      ASSERT_EQ(all.events, drive_) << "before event " << event;
      ASSERT_EQ(all.damages.size(), 1U);
      ASSERT_EQ(all.damages[0].end - all.damages[0].begin, garbage.size());
    }
  }
}

TEST_F(LogReaderTest, OverwrittenPieceTakesOnlyWhatItTouches) {
  const Bytes whole = read_bytes(file_);
  std::mt19937 random(20110926);
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes = whole;
    const std::size_t begin = random() % whole.size();
    const std::size_t end = std::min(whole.size(), begin + 1 + random() % 2000);
    for (std::size_t i = begin; i < end; ++i) bytes[i] = static_cast<std::uint8_t>(random());
    const Reading all = read(bytes);
    for (std::size_t i = 0; i < drive_.size(); ++i) {
      const bool touched = begin < offsets_[i + 1] && end > offsets_[i];
      // The event before the piece may be of unknown type without a similar earlier one: 4 and 5.
      const bool doubtful = begin == offsets_[i + 1] && (i == 4 || i == 5);
      if (touched || doubtful) continue;
      ASSERT_TRUE(std::find(all.events.begin(), all.events.end(), drive_[i]) != all.events.end())
          << "event " << i << " of bytes " << begin << " to " << end;
    }
  }
}

TEST_F(LogReaderTest, BitsAnywhereNeverCrash) {
  const Bytes whole = read_bytes(file_);
  std::mt19937 random(20110926);
  for (int round = 0; round < 3000; ++round) {
    Bytes bytes = whole;
    for (auto n = 1 + random() % 40; n > 0; --n) {
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    read(bytes);
  }
}

TEST_F(LogReaderTest, LogInsideAMessageIsData) {
  auto events = drive_;
  events[7].data = read_bytes(file_);
  record(file_, events);
  EXPECT_EQ(read_all(file_).events, events);
}

TEST_F(LogReaderTest, DamagedCompressedLogGivesWhatComesBefore) {
  const auto compressed = folder_.path() / "cut.lcmlog.gz";
  write_compressed(compressed, read_bytes(file_));
  Bytes bytes = read_bytes(compressed);
  bytes.erase(bytes.end() - 12, bytes.end());
  write_bytes(compressed, bytes);
  const Reading all = read_all(compressed);
  ASSERT_FALSE(all.damages.empty());
  EXPECT_NE(all.damages.back().reason.find("compressed"), std::string::npos);
  ASSERT_LE(all.events.size(), drive_.size());
  EXPECT_TRUE(std::equal(all.events.begin(), all.events.end(), drive_.begin()));
}

TEST_F(LogReaderTest, EventsBeyondTheLimitAreDamage) {
  LogLimits limits;
  limits.data_bytes = 100;
  const Reading all = read_all(file_, limits);
  EXPECT_FALSE(all.damages.empty());
  EXPECT_TRUE(std::all_of(all.events.begin(), all.events.end(),
                          [](const TestEvent& e) { return e.data.size() <= 100; }));
}

// Each header declares 64 MB of data that begin in the next header: the reader must not spend time
// or memory on them.
TEST_F(LogReaderTest, HeadersThatPromiseTheMost) {
  Bytes bytes(20'000 * kHeaderBytes);
  for (std::size_t i = 0; i < 20'000; ++i) {
    write_header(
        {.sync = kSyncWord,
         .number = static_cast<std::int64_t>(i),
         .time_us = 0,
         .channel_bytes = 999,
         .data_bytes = 1 << 26},
        std::span<std::uint8_t, kHeaderBytes>(bytes.data() + i * kHeaderBytes, kHeaderBytes));
  }
  const Reading all = read(bytes);
  EXPECT_TRUE(all.events.empty());
  EXPECT_EQ(all.damages.size(), 1U);
}

TEST_F(LogReaderTest, NothingButSyncWords) {
  Bytes bytes;
  for (int i = 0; i < 100'000; ++i) bytes.insert(bytes.end(), {0xED, 0xA1, 0xDA, 0x01});
  EXPECT_EQ(read(bytes).damages.size(), 1U);
}

TEST_F(LogReaderTest, NamesWhatItCannotOpen) {
  for (const auto& file : {folder_.path() / "missing.lcmlog", folder_.path()}) {
    try {
      LogReader reader(file, types());
      FAIL() << file;
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find(file.string()), std::string::npos);
    }
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
