// The UDP packets of a network capture (pcap, pcapng).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "msgs/time.h"

namespace maploop::sensors {

struct CapturedPacket {
  Time time{};                            // of the capture
  std::uint32_t source = 0;               // IPv4 address
  std::uint16_t port = 0;                 // it was sent to
  std::span<const std::uint8_t> payload;  // until the next packet is read
};

// Plain or .gz. Ethernet (with VLAN tags), Linux's "any" device and raw IP; IPv4. One thread at a
// time.
class CaptureReader {
 public:
  // Throws std::runtime_error naming the file: missing, no capture, or of another kind of network.
  explicit CaptureReader(const std::filesystem::path& file);
  ~CaptureReader();

  // False at the end, also where that is not the file's.
  bool next(CapturedPacket& packet);

  std::uint64_t others() const { return others_; }  // that are no whole UDP packet
  // Why it ended before the file's end; empty where it did not.
  const std::string& damage() const { return damage_; }

 private:
  struct File;
  std::unique_ptr<File> file_;
  std::uint64_t others_ = 0;
  std::string damage_;
};

}  // namespace maploop::sensors
