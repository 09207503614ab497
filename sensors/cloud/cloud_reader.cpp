#include <liblzf/lzf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <utility>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "sensors/cloud/cloud_file.h"
#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

using Words = std::vector<std::string_view>;

struct CloudField {
  std::string_view name;
  std::pair<char, std::size_t> type;   // F, I or U as in PCD, and bytes
  std::size_t count = 1;               // values in a point
  std::size_t offset = 0, column = 0;  // bytes and values of a point before the field
};

struct Layout {
  std::vector<CloudField> fields;
  std::size_t points = 0, row = 0, columns = 0;  // number; bytes and values of each
  CloudEncoding encoding = CloudEncoding::ascii;
};

// Reads a file line by line.
class Lines {
 public:
  explicit Lines(std::string_view content) : left(content) {}

  // Returns the words of the next line that has any; none at the end of the file.
  Words next() {
    constexpr std::string_view blanks = " \t\r\v\f";
    Words words;
    while (words.empty() && !left.empty()) {
      ++number_;
      const std::string_view line = left.substr(0, left.find('\n'));
      left.remove_prefix(std::min(left.size(), line.size() + 1));
      for (std::size_t end, begin = 0;
           (begin = line.find_first_not_of(blanks, begin)) < line.size(); begin = end) {
        if (words.size() == input_limits::columns) fail("the line has too many words");
        end = std::min(line.find_first_of(blanks, begin), line.size());
        words.push_back(line.substr(begin, end - begin));
      }
    }
    return words;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw std::runtime_error("line " + std::to_string(number_) + ": " + reason);
  }

  // Returns word `i` as a number of that type; also nan, which stands for a missing return.
  template <class Number>
  Number number(const Words& words, std::size_t i) const {
    const std::string_view word = i < words.size() ? words[i] : std::string_view();
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      fail(quoted(word) + " in place " + std::to_string(i + 1) +
           " is not a number that fits there");
    }
    return value;
  }

  std::string_view left;

 private:
  std::size_t number_ = 0;
};

using Count = std::uint32_t;  // of points, values, bytes

Layout pcd_layout(Lines& lines) {
  const std::map<std::string_view, CloudEncoding> encodings{
      {"ascii", CloudEncoding::ascii},
      {"binary", CloudEncoding::binary},
      {"binary_compressed", CloudEncoding::compressed}};
  std::map<std::string_view, Words> values;  // by their key, which is the first of them
  for (Words words; words.empty() || words[0] != "DATA"; values[words[0]] = words) {
    words = lines.next();
    if (words.empty() || values.size() > 100)
      lines.fail("neither a PCD, whose header ends with DATA, nor a PLY");
  }
  Layout layout;
  const auto encoding = encodings.find(values["DATA"].back());
  if (encoding == encodings.end()) lines.fail("DATA must be ascii, binary or binary_compressed");
  layout.encoding = encoding->second;
  layout.points = lines.number<Count>(values["POINTS"], 1);
  const Words& names = values["FIELDS"];
  for (const char* key : {"SIZE", "TYPE", "COUNT"}) {
    const bool missing = values.count(key) == 0 && key == std::string_view("COUNT");
    if (!missing && values[key].size() != names.size())
      lines.fail(std::string("the header needs FIELDS, and ") + key + " with a value for each");
  }
  for (std::size_t i = 1; i < names.size(); ++i) {
    const Count count = values.count("COUNT") == 0 ? 1 : lines.number<Count>(values["COUNT"], i);
    layout.fields.push_back(
        {names[i], {values["TYPE"][i][0], lines.number<Count>(values["SIZE"], i)}, count});
  }
  return layout;
}

Layout ply_layout(Lines& lines) {
  const std::map<std::string_view, std::pair<char, std::size_t>> types{
      {"char", {'I', 1}},  {"int8", {'I', 1}},    {"uchar", {'U', 1}},  {"uint8", {'U', 1}},
      {"short", {'I', 2}}, {"int16", {'I', 2}},   {"ushort", {'U', 2}}, {"uint16", {'U', 2}},
      {"int", {'I', 4}},   {"int32", {'I', 4}},   {"uint", {'U', 4}},   {"uint32", {'U', 4}},
      {"float", {'F', 4}}, {"float32", {'F', 4}}, {"double", {'F', 8}}, {"float64", {'F', 8}}};
  Layout layout;
  int elements = 0;
  for (Words words = lines.next(); words.empty() || words[0] != "end_header";
       words = lines.next()) {
    if (words.empty()) lines.fail("the header of the PLY has no end_header");
    words.resize(3);
    if (words[0] == "format") {
      if (words[1] != "ascii" && words[1] != "binary_little_endian")
        lines.fail("the format must be ascii or binary_little_endian");
      layout.encoding = words[1] == "ascii" ? CloudEncoding::ascii : CloudEncoding::binary;
    } else if (words[0] == "element" && ++elements == 1) {
      if (words[1] != "vertex") lines.fail("the first element of the PLY must be 'vertex'");
      layout.points = lines.number<Count>(words, 2);
    } else if (words[0] == "property" && elements == 1) {  // other elements follow the points
      const auto type = types.find(words[1]);
      if (type == types.end() || layout.fields.size() == input_limits::columns)
        lines.fail("a vertex has no property of type " + quoted(words[1]));
      layout.fields.push_back({words[2], type->second});
    }
  }
  return layout;
}

// Completes the layout. Every number of points is checked against the bytes that follow.
void place_fields(const Lines& lines, Layout& layout) {
  constexpr std::size_t longest_row = 1U << 16U;  // bytes
  for (CloudField& field : layout.fields) {
    const auto [type, size] = field.type;
    const bool integer = (type == 'I' || type == 'U') && (size == 1 || size == 2);
    const bool known =
        integer || ((type == 'F' || type == 'I' || type == 'U') && (size == 4 || size == 8));
    if (!known || field.count == 0 || field.count > longest_row)
      lines.fail("field " + quoted(field.name) + " has no known type, size and count");
    field.offset = layout.row;
    field.column = layout.columns;
    layout.row += size * field.count;
    layout.columns += field.count;
    if (layout.row > longest_row) lines.fail("a point has more than 65536 bytes");
  }
  // Each value of a text is followed by a blank or a line's end, except for the last.
  const bool ascii = layout.encoding == CloudEncoding::ascii;
  const std::size_t least = layout.points * (ascii ? 2 * layout.columns : layout.row);
  if (layout.encoding != CloudEncoding::compressed && least > lines.left.size() + ascii) {
    lines.fail("the file is cut: " + std::to_string(layout.points) +
               " points have more than the following " + std::to_string(lines.left.size()) +
               " bytes");
  }
}

// Returns the points of a compressed file, which are stored field by field.
std::string decompressed(const Lines& lines, const Layout& layout) {
  const std::size_t size = layout.points * layout.row;
  std::array<Count, 2> sizes{};  // compressed and not
  if (lines.left.size() >= sizeof sizes) std::memcpy(sizes.data(), lines.left.data(), sizeof sizes);
  if (size > input_limits::cloud || sizes[1] != size) {
    lines.fail("the compressed data are of " + std::to_string(sizes[1]) +
               " bytes, but the points of " + std::to_string(size) + " (at most " +
               std::to_string(input_limits::cloud) + ")");
  }
  std::string plain(size, '\0');
  if (size > 0 && (sizes[0] > lines.left.size() - sizeof sizes ||
                   lzf_decompress(lines.left.data() + sizeof sizes, sizes[0], plain.data(),
                                  sizes[1]) != sizes[1]))
    lines.fail("the compressed data behind this line are cut or damaged");
  return plain;
}

template <class T>
double load(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double load(std::pair<char, std::size_t> type, const char* bytes) {
  if (type.first == 'F') return type.second == 4 ? load<float>(bytes) : load<double>(bytes);
  const bool whole = type.first == 'I';
  switch (type.second) {
    case 1:
      return whole ? load<std::int8_t>(bytes) : load<std::uint8_t>(bytes);
    case 2:
      return whole ? load<std::int16_t>(bytes) : load<std::uint16_t>(bytes);
    case 4:
      return whole ? load<std::int32_t>(bytes) : load<std::uint32_t>(bytes);
    default:
      return whole ? load<std::int64_t>(bytes) : load<std::uint64_t>(bytes);
  }
}

}  // namespace

Cloud parse_cloud(std::string_view content) {
  Lines lines(content);
  Layout layout = content.starts_with("ply") ? ply_layout(lines) : pcd_layout(lines);
  place_fields(lines, layout);
  const auto find = [&](std::initializer_list<std::string_view> names) -> const CloudField* {
    for (const std::string_view name : names) {
      for (const CloudField& field : layout.fields)
        if (field.name == name) return &field;
    }
    return nullptr;
  };
  const std::array fields{find({"x"}), find({"y"}), find({"z"}),
                          find({"intensity", "reflectance", "reflectivity"}),
                          find({"time", "t", "timestamp"})};
  if (fields[0] == nullptr || fields[1] == nullptr || fields[2] == nullptr)
    lines.fail("the header has no fields x, y and z");

  const bool ascii = layout.encoding == CloudEncoding::ascii;
  const bool by_field = layout.encoding == CloudEncoding::compressed;
  const std::string plain = by_field ? decompressed(lines, layout) : "";
  const char* const data = by_field ? plain.data() : lines.left.data();
  Cloud cloud;
  cloud.points.reserve(layout.points);
  for (std::size_t i = 0; i < layout.points; ++i) {
    const Words words = ascii ? lines.next() : Words();
    if (ascii && words.size() != layout.columns) {
      lines.fail("point " + std::to_string(i + 1) + " of " + std::to_string(layout.points) +
                 " has " + std::to_string(words.size()) + " values in place of " +
                 std::to_string(layout.columns));
    }
    std::array<double, fields.size()> v{};  // 0 for a field that the file does not have
    for (std::size_t k = 0; k < fields.size(); ++k) {
      if (fields[k] == nullptr) continue;
      const CloudField& f = *fields[k];
      v[k] = ascii ? lines.number<double>(words, f.column)
                   : load(f.type,
                          data + (by_field ? f.offset * layout.points + i * f.count * f.type.second
                                           : f.offset + i * layout.row));
    }
    const LidarPoint p{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]),
                       static_cast<float>(v[3])};
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z) ||
        !std::isfinite(p.reflectance) || !std::isfinite(v[4]))
      continue;
    cloud.points.push_back(p);
    if (fields[4] != nullptr) cloud.times.push_back(v[4]);
  }
  if (cloud.points.empty()) throw std::runtime_error("the cloud has no finite point");
  return cloud;
}

Cloud read_cloud(const std::filesystem::path& file) {
  const std::string content = maploop::read_text(file, input_limits::cloud);
  try {
    return parse_cloud(content);
  } catch (const std::bad_alloc&) {
    throw FileError(file, "the cloud does not fit into memory");
  } catch (const std::runtime_error& error) {
    throw FileError(file, error.what());
  }
}

}  // namespace maploop::sensors
