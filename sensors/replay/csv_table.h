// A table of numbers with a heading, as a CSV file.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace maploop::sensors {

class CsvTable {
 public:
  // Plain or .gz. Throws std::runtime_error naming file and line: not readable, no heading, a row
  // of another length, or a cell that is not a finite number.
  explicit CsvTable(const std::filesystem::path& file);

  std::size_t size() const { return columns_.empty() ? 0 : cells_.size() / columns_.size(); }
  std::span<const double> row(std::size_t i) const {
    return std::span(cells_).subspan(i * columns_.size(), columns_.size());
  }
  std::size_t line(std::size_t i) const { return i + 2; }  // in the file
  // Throws std::runtime_error naming the file where it has no such column.
  std::size_t column(const std::string& name) const;
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::vector<std::string> columns_;
  std::vector<double> cells_;
};

}  // namespace maploop::sensors
