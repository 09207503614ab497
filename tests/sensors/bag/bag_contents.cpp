#include "tests/sensors/bag/bag_contents.h"

#include <openssl/evp.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>

#include "tests/support/real_data.h"

namespace maploop::testing {

using sensors::MessageReader;

std::map<std::string, std::vector<ReadMessage>> BagContents::by_topic() const {
  std::map<std::string, std::vector<ReadMessage>> all;
  for (const ReadMessage& message : messages) all[message.topic].push_back(message);
  return all;
}

std::map<std::string, std::size_t> BagContents::counts() const {
  std::map<std::string, std::size_t> all;
  for (const ReadMessage& message : messages) ++all[message.topic];
  return all;
}

BagContents read_bag(const std::filesystem::path& path,
                     const sensors::MessageSelection& selection) {
  BagContents contents;
  const auto reader = sensors::open_messages(path, selection);
  for (auto item = reader->next(); item != MessageReader::Item::end; item = reader->next()) {
    if (item == MessageReader::Item::damage) {
      contents.damage.push_back(reader->damage());
      continue;
    }
    const sensors::RecordedMessage& message = reader->message();
    contents.topics.emplace(message.topic->name, *message.topic);
    contents.messages.push_back(
        {message.topic->name, message.received,
         std::string(reinterpret_cast<const char*>(message.data.data()), message.data.size())});
  }
  return contents;
}

std::vector<std::filesystem::path> real_bags() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(real_data() / "bags")) {
    if (entry.is_regular_file() && sensors::is_bag(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::filesystem::path recorded_bag(const std::string& name) {
  return real_data() / "bags/recorded" / name;
}

std::filesystem::path kitti_bag(const std::string& name) {
  return real_data() / "bags/kitti_0013" / name;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::filesystem::path write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

std::string sha256(const std::vector<ReadMessage>& messages) {
  EVP_MD_CTX* const context = EVP_MD_CTX_new();
  EVP_DigestInit_ex(context, EVP_sha256(), nullptr);
  for (const ReadMessage& message : messages) {
    const std::int64_t stamp = to_nanoseconds(message.received);
    EVP_DigestUpdate(context, &stamp, sizeof stamp);
    EVP_DigestUpdate(context, message.data.data(), message.data.size());
  }
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned size = 0;
  EVP_DigestFinal_ex(context, digest, &size);
  EVP_MD_CTX_free(context);
  std::string text;
  for (unsigned i = 0; i < size; ++i) {
    text += "0123456789abcdef"[digest[i] >> 4U];
    text += "0123456789abcdef"[digest[i] & 15U];
  }
  return text;
}

std::uint64_t mcap_summary_start(const std::string& bytes) {
  std::uint64_t start = 0;  // of the footer's three fields, before the magic
  std::memcpy(&start, bytes.data() + bytes.size() - 8 - 20, sizeof start);
  return start;
}

std::uint64_t ros1_index_position(const std::string& bytes) {
  std::uint64_t position = 0;
  std::memcpy(&position, bytes.data() + bytes.find("index_pos=") + 10, sizeof position);
  return position;
}

}  // namespace maploop::testing
