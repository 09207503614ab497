// Checks whether a log is valid, and lists its faults.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

struct VerifyParameters {
  // Threads of one vehicle may log in another order than that of their data's times. Across
  // channels, time may go back by this much; within a channel it must not go back at all.
  double max_disorder_s = 1.0;
  std::size_t max_listed = 1000;  // findings kept in the list; all are counted
};

struct Finding {
  std::uint64_t offset = 0;  // byte of the (uncompressed) log
  std::int64_t event = -1;   // number of the event concerned, or -1
  std::string reason;
};

struct Verification {
  std::string file;
  std::uint64_t events = 0, bytes = 0;
  std::uint64_t decoded = 0;    // messages of known type, read to their last byte
  std::uint64_t unknown = 0;    // messages of unknown types, which are not decoded
  std::uint64_t disorders = 0;  // times that went back by no more than allowed
  std::vector<Finding> findings;
  std::uint64_t finding_count = 0;
};

// Looks for damage, event numbers that do not increase by one, times that go back, and messages of
// known type that do not decode. Throws std::runtime_error naming the file if it cannot be read.
Verification verify(const std::filesystem::path& file, const schema::Schema& schema,
                    const VerifyParameters& parameters = {});

std::string format_findings(const Verification& verification);

}  // namespace maploop::lcm_log
