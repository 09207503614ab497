#include "sensors/replay/files.h"

#include <zlib.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <system_error>

namespace maploop::sensors {
namespace {

constexpr std::string_view blanks = " \t\r\n\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

double parse_number(std::string_view word, std::size_t column) {
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    throw std::invalid_argument("column " + std::to_string(column) +
                                " is not a finite number: " + quoted(word));
  }
  return value;
}

// Of gzip data, of one member or several.
std::string inflated(std::vector<char>& bytes, std::size_t limit) {
  z_stream stream{};
  constexpr int gzip_alone = 15 + 16;
  if (inflateInit2(&stream, gzip_alone) != Z_OK) throw std::runtime_error("cannot decompress");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::string text;
  std::array<char, 1 << 16> part{};
  for (int state = Z_OK; state != Z_STREAM_END || stream.avail_in > 0;) {
    if (state == Z_STREAM_END) inflateReset(&stream);
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    state = inflate(&stream, Z_NO_FLUSH);
    if (state != Z_OK && state != Z_STREAM_END) {
      throw std::runtime_error("its compressed data are damaged or cut: get it once more");
    }
    text.append(part.data(), part.size() - stream.avail_out);
    if (text.size() > limit) {
      throw std::runtime_error("too large: more than " + std::to_string(limit) +
                               " bytes when decompressed");
    }
  }
  return text;
}

}  // namespace

void read_file(const std::filesystem::path& file, std::size_t limit, std::vector<char>& bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw std::runtime_error("the file is missing");
  }
  // Nothing else is opened: a pipe, for one, would wait for ever.
  if (!std::filesystem::is_regular_file(status)) throw std::runtime_error("not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw std::runtime_error("cannot be read: " + error.message());
  if (size > limit) {
    throw std::runtime_error("too large: " + std::to_string(size) + " bytes, at most " +
                             std::to_string(limit) + " expected");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot be opened: no permission to read it?");
  bytes.resize(static_cast<std::size_t>(size));
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) {
    throw std::runtime_error("cannot be read to its end");
  }
}

std::string read_text(const std::filesystem::path& file) {
  constexpr std::size_t limit = std::size_t{64} << 20;
  std::vector<char> bytes;
  read_file(file, limit, bytes);
  const bool compressed = bytes.size() > 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
  return compressed ? inflated(bytes, limit) : std::string(bytes.begin(), bytes.end());
}

std::vector<std::string_view> split_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.push_back(trimmed(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

std::vector<double> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  while (!(text = trimmed(text)).empty()) {
    const std::string_view word = text.substr(0, text.find_first_of(blanks));
    numbers.push_back(parse_number(word, numbers.size() + 1));
    text.remove_prefix(word.size());
  }
  return numbers;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string shown = "'";
  for (const char c : text.substr(0, longest)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (text.size() > longest ? "...'" : "'");
}

std::string numbered_file(std::size_t index, std::string_view extension) {
  constexpr std::size_t digits = 10;
  std::string number = std::to_string(index);
  if (number.size() < digits) number.insert(0, digits - number.size(), '0');
  return number.append(extension);
}

}  // namespace maploop::sensors
