// This file reads a table of numbers with a heading from a CSV file.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace maploop::sensors {

class CsvTable {
 public:
  // Reads a plain or .gz file. Throws std::runtime_error that names file and line: not readable, no
  // heading, a row of another length, or a cell that is not a finite number.
  explicit CsvTable(const std::filesystem::path& file);

  std::size_t size() const { return columns_.empty() ? 0 : cells_.size() / columns_.size(); }
  std::span<const double> row(std::size_t i) const {
    return std::span(cells_).subspan(i * columns_.size(), columns_.size());
  }
  std::size_t line(std::size_t i) const { return i + 2; }  // in the file
  // Throws std::runtime_error that names the file if it has no such column.
  std::size_t column(const std::string& name) const;
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::vector<std::string> columns_;
  std::vector<double> cells_;
};

}  // namespace maploop::sensors
