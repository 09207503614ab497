// Reads recordings for their tests.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sensors/bag/message_reader.h"
#include "tests/support/real_data.h"

namespace maploop::testing {

struct ReadMessage {
  std::string topic;
  Time received;
  std::string data;

  bool operator==(const ReadMessage&) const = default;
};

struct BagContents {
  std::vector<ReadMessage> messages;  // in the order in which they came
  std::map<std::string, sensors::Topic> topics;
  std::vector<sensors::BagDamage> damage;

  // Messages of each topic, in order.
  std::map<std::string, std::vector<ReadMessage>> by_topic() const;
  std::map<std::string, std::size_t> counts() const;
};

inline std::span<const std::uint8_t> as_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

BagContents read_bag(const std::filesystem::path& path,
                     const sensors::MessageSelection& selection = {});

// Returns the files of bags/recorded and bags/kitti_0013 of the real data that are recordings.
std::vector<std::filesystem::path> real_bags();
std::filesystem::path recorded_bag(const std::string& name);
std::filesystem::path kitti_bag(const std::string& name);

std::string bytes_of(const std::filesystem::path& file);
std::filesystem::path write_bytes(const std::filesystem::path& file, const std::string& bytes);
std::string sha256(const std::vector<ReadMessage>& messages);

// Return where the index begins that a file's end, or beginning, names.
std::uint64_t mcap_summary_start(const std::string& bytes);
std::uint64_t ros1_index_position(const std::string& bytes);

}  // namespace maploop::testing
