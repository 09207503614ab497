#include "runtime/core/realtime_text.h"

#include <charconv>
#include <fstream>
#include <iterator>

#include "msgs/trimmed.h"

namespace maploop::runtime {
namespace {

constexpr int highest_cpu = 1 << 16;  // far above any machine; limits the length of a made-up range

// Takes a CPU's number off the beginning of the text.
std::optional<int> take_cpu(std::string_view& text) {
  int cpu = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), cpu);
  if (error != std::errc{} || cpu < 0 || cpu > highest_cpu) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return cpu;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

std::optional<std::string> read_system_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return {};
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) return {};
  if (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

std::optional<std::string_view> line_value(std::string_view text, std::string_view key) {
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.substr(0, key.size()) != key) continue;
    line = trimmed(line.substr(key.size()));
    if (take(line, ':')) return trimmed(line);
  }
  return {};
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  text = trimmed(text);
  std::int64_t value = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc{}) return {};
  return value;
}

std::optional<std::vector<int>> parse_cpu_list(std::string_view text) {
  text = trimmed(text);
  std::vector<int> cpus;
  if (text.empty()) return cpus;
  do {
    const std::optional<int> first = take_cpu(text);
    const std::optional<int> last = first && take(text, '-') ? take_cpu(text) : first;
    if (!last || *last < *first) return {};
    for (int cpu = *first; cpu <= *last; ++cpu) cpus.push_back(cpu);
  } while (take(text, ','));
  if (!text.empty()) return {};
  return cpus;
}

std::string to_cpu_list(const std::vector<int>& ascending) {
  std::string text;
  for (std::size_t i = 0; i < ascending.size();) {
    std::size_t last = i;
    while (last + 1 < ascending.size() && ascending[last + 1] == ascending[last] + 1) ++last;
    if (!text.empty()) text += ',';
    text += std::to_string(ascending[i]);
    if (last > i) text += '-' + std::to_string(ascending[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace maploop::runtime
