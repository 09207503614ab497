// This file reads the UDP packets of a network capture (pcap, pcapng).
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
  std::uint16_t port = 0;                 // destination port
  std::span<const std::uint8_t> payload;  // valid until the next packet is read
};

// Reads plain or .gz files of Ethernet (with VLAN tags), Linux's "any" device and raw IP; IPv4. One
// thread at a time.
class CaptureReader {
 public:
  // Throws std::runtime_error that names the file: missing, not a capture, or of another kind of
  // network.
  explicit CaptureReader(const std::filesystem::path& file);
  ~CaptureReader();

  // Returns false at the end, also if damage() ends it before the file's end.
  bool next(CapturedPacket& packet);

  std::uint64_t others() const { return others_; }  // frames that are not a whole UDP packet
  // States why reading stopped before the file's end; empty if it did not.
  const std::string& damage() const { return damage_; }

 private:
  struct File;
  std::unique_ptr<File> file_;
  std::uint64_t others_ = 0;
  std::string damage_;
};

}  // namespace maploop::sensors
