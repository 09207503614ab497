// This file reads a table of numbers with named columns: CSV, NumPy's .npy, RTKLIB's .pos.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::sensors {

// These are the cells, row by row. Whole numbers beyond 2^53, such as nanoseconds, are kept beside
// the doubles.
struct NumberCells {
  std::vector<std::string> columns;
  std::vector<double> values;
  std::vector<std::int64_t> whole;  // of column `time`; NumberTable::none where it has a fraction
};

struct NumberTableOptions {
  std::vector<std::string> columns = {};  // names, where the file has no heading
  std::string time = {};                  // the column whose whole numbers are kept
  bool missing = false;                   // empty cells and `nan` are allowed, and are NaN
};

// Returns whether the name is that of RTKLIB's solutions, plain or .gz.
bool is_pos_file(const std::filesystem::path& file);

class NumberTable {
 public:
  static constexpr std::int64_t none = std::numeric_limits<std::int64_t>::min();

  // Reads a plain or .gz file, told apart by name. In CSV, cells are separated by commas,
  // semicolons or blanks, and lines that begin with # after the heading are comments. Throws
  // std::runtime_error that names file and line: not readable, no heading, a row of another length,
  // or a cell that is not a finite number.
  explicit NumberTable(const std::filesystem::path& file, const NumberTableOptions& options = {});

  std::size_t size() const {
    return cells_.columns.empty() ? 0 : cells_.values.size() / cells_.columns.size();
  }
  std::span<const double> row(std::size_t i) const {
    return std::span(cells_.values).subspan(i * cells_.columns.size(), cells_.columns.size());
  }
  // Returns the whole number in the column of times, or none.
  std::int64_t whole(std::size_t i) const {
    return i < cells_.whole.size() ? cells_.whole[i] : none;
  }
  std::size_t line(std::size_t i) const {
    return i < lines_.size() ? lines_[i] : i + 1;
  }  // in the file
  bool has(std::string_view name) const;
  // Throws std::runtime_error that names the file if it has no such column.
  std::size_t column(const std::string& name) const;
  const std::filesystem::path& file() const { return file_; }

 private:
  void read_text_table(std::string text, const NumberTableOptions& options);

  std::filesystem::path file_;
  NumberCells cells_;
  std::vector<std::size_t> lines_;
};

// Parses the content of a .npy: an array of numbers in two dimensions (`columns` names them), or of
// one dimension with named fields (dtype [('t', '<f8'), ...]). Throws std::invalid_argument whose
// text is the reason.
NumberCells parse_npy(std::string_view content, const NumberTableOptions& options);

// Parses RTKLIB's solutions: the columns are those of the heading in its comments, without units,
// after `time`, in seconds from 1970 in the time scale that the first column is named by: `GPST` or
// `UTC`. Throws std::invalid_argument whose text is the reason, with the line.
NumberCells parse_pos(std::string_view content);

}  // namespace maploop::sensors
