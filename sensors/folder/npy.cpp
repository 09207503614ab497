// Reads NumPy's .npy files: NEP 1, "A Simple File Format for NumPy Arrays".
#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "msgs/input_limits.h"
#include "sensors/folder/number_table.h"
#include "sensors/number.h"

namespace maploop::sensors {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

struct NpyField {
  std::string name;
  char kind = 'f';  // f, i, u
  std::size_t size = 8;
  bool big_endian = false;
};

[[noreturn]] void refuse_npy(const std::string& why) {
  throw std::invalid_argument(why);
}

// Returns the text between quotes that begins at or after `at`, and moves `at` behind it.
std::optional<std::string_view> quoted_word(std::string_view text, std::size_t& at) {
  const std::size_t open = text.find_first_of("'\"", at);
  if (open == std::string_view::npos) return std::nullopt;
  const std::size_t close = text.find(text[open], open + 1);
  if (close == std::string_view::npos) return std::nullopt;
  at = close + 1;
  return text.substr(open + 1, close - open - 1);
}

NpyField npy_field(std::string_view name, std::string_view type) {
  NpyField field;
  field.name = name;
  const bool ordered = !type.empty() && std::string_view("<>|=").find(type[0]) != type.npos;
  field.big_endian = type.starts_with('>');
  const std::string_view rest = type.substr(ordered ? 1 : 0);
  const auto size = parse_number<std::size_t>(rest.substr(rest.empty() ? 0 : 1));
  const bool is_float = rest.starts_with('f');
  const bool known = (is_float || rest.starts_with('i') || rest.starts_with('u')) && size &&
                     (*size == 4 || *size == 8 || (!is_float && (*size == 1 || *size == 2)));
  if (!known) {
    refuse_npy("has the type '" + std::string(type.substr(0, 20)) +
               "' in place of f4, f8, i1 to i8 or u1 to u8: save the array as numbers");
  }
  field.kind = rest[0];
  field.size = *size;
  return field;
}

// Returns what follows a key of the header's dictionary.
std::string_view npy_value(std::string_view header, std::string_view key) {
  for (const char quote : {'\'', '"'}) {
    const std::string name = quote + std::string(key) + quote;
    const std::size_t at = header.find(name);
    if (at == std::string_view::npos) continue;
    const std::size_t colon = header.find(':', at);
    if (colon != std::string_view::npos) return header.substr(colon + 1);
  }
  refuse_npy("its header has no '" + std::string(key) + "'");
}

std::vector<NpyField> npy_fields(std::string_view header) {
  const std::string_view descr = npy_value(header, "descr");
  const std::size_t begin = descr.find_first_not_of(' ');
  std::size_t at = 0;
  if (begin == std::string_view::npos || descr[begin] != '[') {
    const auto type = quoted_word(descr, at);
    if (!type) refuse_npy("its header has no type");
    return {npy_field("", *type)};
  }
  const std::string_view list = descr.substr(0, descr.find(']'));
  std::vector<NpyField> fields;
  while (const auto name = quoted_word(list, at)) {
    const auto type = quoted_word(list, at);
    const std::size_t close = list.find(')', at);
    if (!type || close == std::string_view::npos) refuse_npy("its header's fields are incomplete");
    if (list.substr(at, close - at).find_first_of("0123456789") != std::string_view::npos)
      refuse_npy("its field '" + std::string(*name) + "' is an array: save one number a field");
    fields.push_back(npy_field(*name, *type));
    if (fields.size() > input_limits::columns) refuse_npy("has too many fields");
  }
  if (fields.empty()) refuse_npy("its header has no fields");
  return fields;
}

std::vector<std::size_t> npy_shape(std::string_view header) {
  const std::string_view value = npy_value(header, "shape");
  const std::size_t open = value.find('('), close = value.find(')');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open)
    refuse_npy("its header has no shape");
  std::vector<std::size_t> shape;
  std::string_view list = value.substr(open + 1, close - open - 1);
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(','), list.size());
    std::string_view number = list.substr(0, end);
    while (number.starts_with(' ')) number.remove_prefix(1);
    list.remove_prefix(std::min(end + 1, list.size()));
    if (number.empty()) continue;
    const auto length = parse_number<std::size_t>(number);
    if (!length) refuse_npy("its header's shape is not numbers");
    shape.push_back(*length);
  }
  return shape;
}

template <class T>
T npy_number(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

struct NpyCell {
  double value;
  std::int64_t whole;
};

NpyCell npy_cell(const char* bytes, const NpyField& field) {
  char ordered[8];
  for (std::size_t i = 0; i < field.size; ++i)
    ordered[i] = bytes[field.big_endian ? field.size - 1 - i : i];
  if (field.kind == 'f') {
    const double value = field.size == 4 ? static_cast<double>(npy_number<float>(ordered))
                                         : npy_number<double>(ordered);
    return {value, NumberTable::none};
  }
  std::uint64_t bits = 0;
  std::memcpy(&bits, ordered, field.size);
  const unsigned unused = 64U - 8U * static_cast<unsigned>(field.size);
  const auto whole = field.kind == 'i' ? static_cast<std::int64_t>(bits << unused) >> unused
                                       : static_cast<std::int64_t>(bits);
  if (field.kind == 'u' && whole < 0) return {static_cast<double>(bits), NumberTable::none};
  return {static_cast<double>(whole), whole};
}

struct NpyHeader {
  std::string_view text, data;
};

NpyHeader npy_header(std::string_view content) {
  if (!content.starts_with("\x93NUMPY") || content.size() < 12) refuse_npy("is not a .npy file");
  const auto byte = [&](std::size_t i) {
    return std::size_t{static_cast<unsigned char>(content[i])};
  };
  const bool long_header = byte(6) > 1;  // version 1 has two bytes of length, 2 and 3 have four
  std::size_t length = byte(8) | byte(9) << 8U, begin = 10;
  if (long_header) {
    length |= byte(10) << 16U | byte(11) << 24U;
    begin = 12;
  }
  if (length > content.size() - begin) refuse_npy("its header is cut");
  return {content.substr(begin, length), content.substr(begin + length)};
}

}  // namespace

NumberCells parse_npy(std::string_view content, const NumberTableOptions& options) {
  const NpyHeader header = npy_header(content);
  std::vector<NpyField> fields = npy_fields(header.text);
  const std::vector<std::size_t> shape = npy_shape(header.text);
  const bool structured = !fields[0].name.empty() || fields.size() > 1;
  if (shape.size() != (structured ? 1U : 2U))
    refuse_npy(
        "has " + std::to_string(shape.size()) +
        " dimensions: a table is an array of rows and columns, or of rows with named fields");
  const std::size_t rows = shape[0];
  if (!structured) {
    if (options.columns.size() != shape[1]) {
      refuse_npy("has " + std::to_string(shape[1]) + " columns, but `columns` names " +
                 std::to_string(options.columns.size()));
    }
    const NpyField field = fields[0];
    fields.assign(options.columns.size(), field);
    for (std::size_t k = 0; k < fields.size(); ++k) fields[k].name = options.columns[k];
  }
  std::size_t width = 0;
  for (const NpyField& field : fields) width += field.size;
  if (rows > input_limits::frames || rows * width > header.data.size()) {
    refuse_npy("has " + std::to_string(rows) +
               " rows, which are not all in the file or more than " +
               std::to_string(input_limits::frames));
  }
  const std::string_view order = npy_value(header.text, "fortran_order");
  const bool by_column = !structured && order.substr(0, order.find(',')).find("True") != order.npos;
  NumberCells cells;
  for (const NpyField& field : fields) cells.columns.push_back(field.name);
  cells.values.reserve(rows * fields.size());
  for (std::size_t row = 0; row < rows; ++row) {
    std::size_t in_row = 0;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const std::size_t at = by_column ? (k * rows + row) * fields[k].size : row * width + in_row;
      const NpyCell cell = npy_cell(header.data.data() + at, fields[k]);
      in_row += fields[k].size;
      cells.values.push_back(cell.value);
      if (fields[k].name == options.time) cells.whole.push_back(cell.whole);
    }
  }
  return cells;
}

}  // namespace maploop::sensors
