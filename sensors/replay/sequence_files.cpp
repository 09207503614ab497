#include "sensors/replay/sequence_files.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/shared_folder.h"
#include "sensors/replay/files.h"
#include "sensors/replay/timestamps.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

// A table whose t begins near zero starts here if its true start is unknown.
constexpr std::string_view unknown_start = "2000-01-01 00:00:00";
constexpr std::string_view list_name = "sequences.csv";

std::optional<fs::path> first_existing(std::initializer_list<fs::path> names) {
  for (const fs::path& name : names) {
    if (auto found = existing_table(name)) return found;
  }
  return std::nullopt;
}

// Holds the first line, and the first number of the second.
struct Begin {
  std::string heading;
  double t = 0.0;
};

Begin begin_of(const fs::path& file) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose);
  Begin begin;
  std::array<char, 1024> line{};
  if (!in || gzgets(in.get(), line.data(), line.size()) == nullptr) return begin;
  begin.heading = split_lines(line.data()).empty() ? "" : split_lines(line.data()).front();
  if (gzgets(in.get(), line.data(), line.size()) == nullptr) return begin;
  const std::string_view row(line.data());
  try {
    const std::vector<double> numbers = parse_numbers(row.substr(0, row.find(',')));
    if (!numbers.empty()) begin.t = numbers.front();
  } catch (const std::invalid_argument&) {
    // The reader of the whole table will report the line.
  }
  return begin;
}

bool is_table(const fs::path& file) {
  fs::path name = file.filename();
  if (name.extension() == ".gz") name.replace_extension();
  std::error_code ignored;
  if (name.extension() != ".csv" || !fs::is_regular_file(file, ignored)) return false;
  const std::string heading = begin_of(file).heading;
  return heading.starts_with("t,") && heading.ends_with(",orimode");
}

// Holds what the list of sequences states about one sequence.
struct Listed {
  std::string start, imu, tracks;
};

std::optional<Listed> find_in(const fs::path& list, std::string_view name) {
  const auto file = existing_table(list);
  if (!file) return std::nullopt;
  const std::string text = read_text(*file);
  const auto lines = split_lines(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<std::string> cells;
    for (std::size_t begin = 0; begin <= lines[i].size();) {
      const std::size_t end = std::min(lines[i].find(',', begin), lines[i].size());
      cells.emplace_back(lines[i].substr(begin, end - begin));
      begin = end + 1;
    }
    if (cells.size() != 4 || (i == 0 && cells.front() != "name")) {
      throw std::runtime_error(file->string() + ":" + std::to_string(i + 1) +
                               ": the columns must be name,start,imu,tracks");
    }
    if (cells.front() == name) return Listed{cells[1], cells[2], cells[3]};
  }
  return std::nullopt;
}

// Returns the installed list of KITTI's own sequences.
fs::path own_list() {
  return shared_folder() / "kitti_sequences.csv";
}

std::optional<fs::path> table_at(const fs::path& path) {
  if (is_table(path)) return path;
  const auto numbered =
      existing_table(path.parent_path() / "oxts" / (path.filename().string() + ".csv"));
  return numbered && is_table(*numbered) ? numbered : std::nullopt;
}

}  // namespace

std::optional<fs::path> existing_table(const fs::path& name) {
  std::error_code ignored;
  if (fs::is_regular_file(name, ignored)) return name;
  const fs::path packed = name.string() + ".gz";
  if (fs::is_regular_file(packed, ignored)) return packed;
  return std::nullopt;
}

Time start_of_seconds(double first) {
  constexpr double since_1970 = 1e8;  // s: no drive lasts three years
  return first < since_1970 ? parse_time(unknown_start) : Time{};
}

std::optional<SequenceFiles> find_sequence(const fs::path& path) {
  const auto table = table_at(path);
  if (!table) return std::nullopt;
  fs::path stem = table->filename();
  if (stem.extension() == ".gz") stem.replace_extension();
  const std::string name = stem.stem().string();
  const fs::path beside = fs::absolute(*table).parent_path(), above = beside.parent_path();

  SequenceFiles files;
  files.table = *table;
  files.gaps = existing_table(beside / (name + ".gaps.csv"));
  files.times =
      first_existing({beside / (name + ".times.txt"), above / "poses" / (name + ".times.txt")});
  files.imu = existing_table(beside / (name + ".imu.csv"));
  files.tracks = existing_table(beside / (name + ".tracks.csv"));
  files.labels =
      first_existing({beside / (name + ".labels.csv"), above / "labels" / (name + ".csv")});

  std::optional<Listed> listed = find_in(beside / list_name, name);
  if (!listed) listed = find_in(above / list_name, name);
  if (!listed && beside.filename() == "oxts") listed = find_in(own_list(), name);
  if (listed && !files.imu && !listed->imu.empty()) files.imu = existing_table(above / listed->imu);
  if (listed && !files.tracks && !listed->tracks.empty()) {
    files.tracks = existing_table(above / listed->tracks);
  }
  files.start = start_of_seconds(begin_of(*table).t);
  if (files.start != Time{} && listed && !listed->start.empty()) {
    files.start = parse_time(listed->start);
  }
  return files;
}

}  // namespace maploop::sensors
