// Reads the lines of a text file in fixed columns, plain or gzip-compressed. Errors name file and
// line.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "msgs/trimmed.h"
#include "ppp/gps_time.h"

namespace maploop::ppp {

// The message is "file:line: what is wrong".
class ReadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Returns the whole content, decompressed if it is gzip (recognized by content). Throws ReadError
// naming the file if it cannot be read, is damaged, or is larger than input_limits::gnss_file.
std::string read_file(const std::filesystem::path& path);
// Returns the first 64 KiB of the content, or fewer if the file is shorter.
std::string read_head(const std::filesystem::path& path);

// Returns columns [first, first + width) of a line, or fewer or none if the line is shorter.
inline std::string_view columns(std::string_view line, std::size_t first, std::size_t width) {
  return first < line.size() ? line.substr(first, width) : std::string_view{};
}
inline bool blank(std::string_view text) {
  return text.find_first_not_of(' ') == std::string_view::npos;
}

// Both accept a number, with blanks around it and an exponent by E or D. They return nothing if the
// text is not a number, is not finite, or does not fit the type.
std::optional<double> parse_number(std::string_view text);
std::optional<int> parse_integer(std::string_view text);

class Lines {
 public:
  // Holds views into `text`, which must outlive this. Bytes of no text at its end are left out:
  // zeros, which an interrupted writer leaves on a disk, and DOS's mark of the end.
  Lines(std::string_view text, std::string file)
      : text_(text.substr(0, text.find_last_not_of(std::string_view("\0\x1a", 2)) + 1)),
        file_(std::move(file)) {}

  // Goes to the next line, without its end of line (\n or \r\n). Returns false at the end of the
  // text.
  bool next();
  // Returns the next line without going there; empty at the end.
  std::string_view peek() const;

  std::string_view line() const { return line_; }
  int line_number() const { return line_number_; }
  const std::string& file() const { return file_; }
  bool whole() const { return whole_; }  // this line has its end of line, so it is not cut

  std::string_view column(std::size_t first, std::size_t width) const {
    return columns(line_, first, width);
  }
  // Both read columns that must hold a number; `what` names it in the error.
  double number(std::size_t first, std::size_t width, const char* what) const;
  int integer(std::size_t first, std::size_t width, const char* what) const;
  // Both return `otherwise` if the columns are blank.
  double number_or(std::size_t first, std::size_t width, double otherwise, const char* what) const;
  int integer_or(std::size_t first, std::size_t width, int otherwise, const char* what) const;

  // Throws ReadError for this line.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view text_, line_;
  std::string file_;
  std::size_t at_ = 0;
  int line_number_ = 0;
  bool whole_ = true;
};

// Both concern the version of a RINEX file of observations or navigation.
constexpr bool supported_rinex(double version) {
  return (version >= 2.0 && version < 2.13) || (version >= 3.0 && version < 3.06) ||
         (version >= 4.0 && version < 4.03);
}
inline constexpr const char* unknown_rinex =
    "unknown version; RINEX 2.00 to 2.12, 3.00 to 3.05 and 4.00 to 4.02 are supported";

// Parses a stamp of six numbers between blanks, "2020 06 25 00 00 30.0000000". A year of two digits
// is within 1980 to 2079. Throws ReadError for the line.
GpsTime parse_stamp(const Lines& lines, std::string_view text);

}  // namespace maploop::ppp
