// Writes an LCM log, plain or compressed, an MCAP file or a bag of ROS 1.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/schema.h"
#include "msgs/whole_file.h"
#include "tools/log/bag_log.h"
#include "tools/log/mcap_log.h"

namespace maploop::lcm_log {

// Return whether a file of this name is written as an MCAP file, or as a bag.
bool is_mcap_name(const std::filesystem::path& file);
bool is_bag_name(const std::filesystem::path& file);

// The name says the format: .mcap (mcap_log.h), .bag (bag_log.h), .gz for a compressed LCM log,
// else an LCM log. The file gets its name in close(). Until then, and if close() is never called, a
// former file of that name stays. Events are numbered from 0, like those of LCM's own writer.
class LogWriter {
 public:
  // This and the functions below throw std::runtime_error naming the file if it cannot be written.
  // The schema must outlive this. A bag is compressed by "none", "lz4" or "bz2".
  LogWriter(const std::filesystem::path& file, const schema::Schema& schema,
            const std::string& bag_compression = "lz4");

  void write(const LogEvent& event);
  void close();

  std::uint64_t events() const { return events_; }
  std::uint64_t bytes() const { return bytes_; }  // as an LCM log, before compression

 private:
  void flush();

  WholeFile file_;
  bool compressed_;
  std::unique_ptr<McapLog> mcap_;  // nullptr: another format
  std::unique_ptr<BagLog> bag_;    // nullptr: another format
  std::string pending_;            // whole events of an LCM log
  std::uint64_t events_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace maploop::lcm_log
