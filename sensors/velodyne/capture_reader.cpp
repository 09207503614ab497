#include "sensors/velodyne/capture_reader.h"

#include <pcap/pcap.h>
#include <stdio.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

namespace maploop::sensors {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::uint16_t u16(Bytes bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

// Returns the IPv4 packet after the link's header; empty if the frame does not contain one.
Bytes ipv4_of(Bytes frame, int link) {
  constexpr std::uint16_t ipv4 = 0x0800, vlan = 0x8100, provider_vlan = 0x88a8;
  std::size_t type_at = 12, header = 14;  // Ethernet
  if (link == DLT_RAW || link == DLT_IPV4) return frame;
  if (link == DLT_LINUX_SLL) {
    type_at = 14;
    header = 16;
  } else if (link == DLT_LINUX_SLL2) {
    type_at = 0;
    header = 20;
  }
  while (frame.size() >= header + 4 && link == DLT_EN10MB &&
         (u16(frame, type_at) == vlan || u16(frame, type_at) == provider_vlan)) {
    type_at += 4;
    header += 4;
  }
  if (frame.size() < header || u16(frame, type_at) != ipv4) return {};
  return frame.subspan(header);
}

// Returns whether this is a whole UDP packet, and fills all but the time.
bool read_udp(Bytes ip, CapturedPacket& packet) {
  constexpr std::size_t udp_header = 8;
  if (ip.size() < 20 || ip[0] >> 4 != 4 || ip[9] != 17) return false;
  const std::size_t header = 4U * (ip[0] & 0xfU);
  const std::size_t total = std::min<std::size_t>(u16(ip, 2), ip.size());
  const bool fragment = (u16(ip, 6) & 0x3fff) != 0;  // more follow, or not the first
  // A VLP-16 states its data packets' total length in its position packets too; UDP's length is
  // right.
  if (fragment || header < 20 || total < header + udp_header) return false;
  const Bytes udp = ip.subspan(header, total - header);
  const std::size_t length = u16(udp, 4);
  if (length < udp_header || length > udp.size()) return false;
  packet.source = static_cast<std::uint32_t>(u16(ip, 12)) << 16 | u16(ip, 14);
  packet.port = u16(udp, 2);
  packet.payload = udp.subspan(udp_header, length - udp_header);
  return true;
}

// libpcap reads through zlib, which passes plain files through unchanged.
FILE* open_through_zlib(const std::filesystem::path& file) {
  gzFile zipped = gzopen(file.c_str(), "rb");
  if (zipped == nullptr) return nullptr;
  cookie_io_functions_t functions{};
  functions.read = [](void* cookie, char* to, std::size_t size) -> ssize_t {
    return gzread(static_cast<gzFile>(cookie), to, static_cast<unsigned>(size));
  };
  functions.close = [](void* cookie) { return gzclose(static_cast<gzFile>(cookie)); };
  FILE* stream = fopencookie(zipped, "r", functions);
  if (stream == nullptr) gzclose(zipped);
  return stream;
}

}  // namespace

struct CaptureReader::File {
  pcap_t* pcap = nullptr;
  int link = 0;
};

CaptureReader::CaptureReader(const std::filesystem::path& path) : file_(std::make_unique<File>()) {
  const auto fail = [&](const std::string& why) {
    throw std::runtime_error("the capture '" + path.string() + "' " + why);
  };
  if (!std::filesystem::is_regular_file(path)) fail("is not a file");
  FILE* stream = open_through_zlib(path);
  if (stream == nullptr) fail("cannot be read");
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  file_->pcap =
      pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, error.data());
  if (file_->pcap == nullptr) {
    fclose(stream);
    fail(std::string("is not a capture: ") + error.data());
  }
  file_->link = pcap_datalink(file_->pcap);
  switch (file_->link) {
    case DLT_EN10MB:
    case DLT_RAW:
    case DLT_IPV4:
    case DLT_LINUX_SLL:
    case DLT_LINUX_SLL2:
      return;
    default: {
      const char* name = pcap_datalink_val_to_name(file_->link);
      const std::string kind = name != nullptr ? name : std::to_string(file_->link);
      pcap_close(file_->pcap);
      fail("was captured on a network of kind " + kind +
           "; Ethernet, Linux 'any' and raw IP are supported");
    }
  }
}

CaptureReader::~CaptureReader() {
  pcap_close(file_->pcap);
}

bool CaptureReader::next(CapturedPacket& packet) {
  constexpr long latest = 7'258'118'400;  // the year 2200: keeps differences within 64 bits
  for (;;) {
    pcap_pkthdr* header = nullptr;
    const unsigned char* data = nullptr;
    const int result = pcap_next_ex(file_->pcap, &header, &data);
    if (result != 1) {
      if (result == PCAP_ERROR) damage_ = pcap_geterr(file_->pcap);
      return false;
    }
    // Because nanoseconds were requested, tv_usec contains nanoseconds.
    const bool dated = header->ts.tv_sec >= 0 && header->ts.tv_sec < latest &&
                       header->ts.tv_usec >= 0 && header->ts.tv_usec < 1'000'000'000;
    packet.time = dated ? Time(std::chrono::seconds(header->ts.tv_sec) +
                               std::chrono::nanoseconds(header->ts.tv_usec))
                        : Time{};
    if (dated && read_udp(ipv4_of({data, header->caplen}, file_->link), packet)) return true;
    ++others_;
  }
}

}  // namespace maploop::sensors
