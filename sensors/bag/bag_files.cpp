#include "sensors/bag/bag_files.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <string_view>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "msgs/trimmed.h"
#include "sensors/bag/mcap_format.h"
#include "sensors/bag/mcap_reader.h"
#include "sensors/bag/ros1_bag_format.h"
#include "sensors/bag/ros1_bag_reader.h"
#include "sensors/bag/sqlite_reader.h"
#include "sensors/bag/unpacked_file.h"

namespace maploop::sensors::bag {
namespace {

namespace fs = std::filesystem;

// Is what maploop reads of rosbag2's metadata.yaml.
struct Metadata {
  std::vector<std::string> files;
  std::string compression;
};

std::string_view unquoted(std::string_view text) {
  return trimmed(text, " \t\r'\"");
}

// rosbag2 writes a key or an item a line. Names of files may contain a folder that does not exist
// any more, and never mean files elsewhere.
Metadata read_metadata(const fs::path& file) {
  constexpr std::string_view files_key = "relative_file_paths:", format_key = "compression_format:";
  const std::string text = read_text(file, input_limits::settings);
  Metadata found;
  bool in_files = false;
  for (std::string_view left = text; !left.empty();) {
    const std::string_view line = unquoted(left.substr(0, left.find('\n')));
    left.remove_prefix(std::min(left.find('\n'), left.size() - 1) + 1);
    if (in_files && line.starts_with("- ")) {
      found.files.push_back(fs::path(unquoted(line.substr(2))).filename());
    } else {
      in_files = line == files_key;
    }
    if (line.starts_with(format_key)) found.compression = unquoted(line.substr(format_key.size()));
  }
  return found;
}

std::vector<fs::path> files_of_folder(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    constexpr std::array endings{".bag", ".db3", ".mcap"};
    fs::path name = entry.path().filename();
    if (name.extension() == ".zstd" || name.extension() == ".gz") name = name.stem();
    if (std::find(endings.begin(), endings.end(), name.extension()) != endings.end() &&
        entry.is_regular_file())
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return strverscmp(a.filename().c_str(), b.filename().c_str()) < 0;
  });
  return files;
}

bool is_recording(std::string_view head) {
  return head.starts_with(ros1_bag_magic) || head.starts_with(mcap_magic) ||
         head.starts_with(sqlite_magic);
}

}  // namespace

bool is_own_recording(const fs::path& file) {
  // Magic, opcode and length of the header, length of the profile.
  constexpr std::size_t profile_at = mcap_magic.size() + 1 + 8 + 4;
  constexpr std::size_t field_at = ros1_bag_line.size() + 4 + 4;  // lengths of all fields and of it
  const auto has = [](std::string_view head, std::string_view magic, std::size_t at,
                      std::string_view mark) {
    return head.starts_with(magic) && head.size() > at && head.substr(at).starts_with(mark);
  };
  try {
    const std::string head = unpacked_head(file);
    return has(head, mcap_magic, profile_at, mcap_profile) ||
           has(head, ros1_bag_line, field_at, ros1_own_field);
  } catch (const std::runtime_error&) {
    return false;
  }
}

bool is_recording_file(const fs::path& file) {
  try {
    return is_recording(unpacked_head(file)) && !is_own_recording(file);
  } catch (const std::runtime_error&) {
    return false;
  }
}

std::vector<fs::path> recording_files(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  if (const fs::path yaml = path / "metadata.yaml"; fs::exists(yaml)) {
    const Metadata metadata = read_metadata(yaml);
    if (!metadata.compression.empty() && metadata.compression != "zstd") {
      throw FileError(yaml, "the compression '" + metadata.compression +
                                "' is not known: convert the recording to zstd or none");
    }
    for (const std::string& name : metadata.files) files.push_back(path / name);
  }
  if (files.empty()) files = files_of_folder(path);
  if (files.empty())
    throw FileError(path, "has neither metadata.yaml of rosbag2 nor files .bag, .db3 or .mcap");
  return files;
}

std::unique_ptr<RecordingReader> open_file(const fs::path& file,
                                           const std::shared_ptr<TopicTable>& topics,
                                           const MessageSelection& selection) {
  const std::string head = unpacked_head(file);
  if (head.empty()) throw FileError(file, "is empty");
  if (!is_recording(head))
    throw FileError(file, "neither a ROS bag nor a file of rosbag2 (.db3, .mcap)");
  const UnpackedFile unpacked(file);
  const Opening opening{file, unpacked.path(), topics, selection};
  if (head.starts_with(ros1_bag_magic)) return std::make_unique<Ros1BagReader>(opening);
  if (head.starts_with(mcap_magic)) return std::make_unique<McapReader>(opening);
  return open_sqlite(opening);
}

}  // namespace maploop::sensors::bag
