// This file reads the rows of one table as samples.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "msgs/input_limits.h"
#include "msgs/local_frame.h"
#include "msgs/reference.h"
#include "sensors/folder/number_table.h"
#include "sensors/folder/table_mapping.h"
#include "sensors/folder/table_rows.h"

namespace maploop::sensors {

// Values in SI units or degrees, in the order in which they are wanted.
using TableValues = std::span<const double>;

// Names a column, its unit, and the least and the most that a value in that unit's SI may be:
// beyond what a vehicle or its sensors can do, so that a damaged number does not pass for a
// measurement.
struct WantedColumn {
  std::string name;
  double unit, least, most;
};

void want(std::vector<WantedColumn>& wanted, const Columns& columns, double least, double most);

// Reads the stamps of a table's rows.
class TableClock {
 public:
  // Throws std::runtime_error that names the file without the column.
  TableClock(const NumberTable& table, const TableFile& file, Time (*utc_of_gps)(Time));

  // Returns the moment at which seconds are zero, if this table is the first one of a recording.
  Time start() const;
  // Throws std::invalid_argument if the row has no time.
  Time stamp(std::size_t row, Time start) const;

 private:
  double seconds(std::size_t row) const;

  const NumberTable& table_;
  const TableFile& file_;
  Time (*utc_of_gps_)(Time);
  std::vector<std::size_t> columns_;
};

// The columns of a position, and the position that their values are. place() throws
// std::invalid_argument if it is not on Earth.
void want_position(std::vector<WantedColumn>& wanted, PositionForm form, const Columns& columns);
Geodetic place(PositionForm form, TableValues values);

constexpr double fastest_receiver = 515.0;  // m/s, where receivers stop
Eigen::Vector3d velocity_enu(VelocityAxes axes, TableValues values, const Geodetic& at);

// Opens a table. Throws std::runtime_error.
struct OpenedTable {
  OpenedTable(const TableFile& file, const TableMapping& mapping);
  OpenedTable(const OpenedTable&) = delete;

  NumberTable table;
  TableClock clock;
};

// Reads the reference. `start` is that of the first table, or becomes that of this one. Returns
// nullptr if the receiver never started its fusion.
std::shared_ptr<const TableRows<ReferencePose>> read_reference(const TableMapping& mapping,
                                                               std::optional<Time>& start);

// Reads the wanted columns; fill(values, sample) makes a sample, which has its stamps, of the
// values in their order, or throws std::invalid_argument.
template <class T, class Fill>
std::shared_ptr<TableRows<T>> read_rows(const NumberTable& table, const TableClock& clock,
                                        Time start, const std::vector<WantedColumn>& wanted,
                                        Fill fill) {
  const std::filesystem::path& file = table.file();
  if (table.size() > input_limits::frames) {
    throw std::runtime_error(file.string() + ": has more than " +
                             std::to_string(input_limits::frames) + " rows; cut the drive");
  }
  std::vector<std::size_t> places;
  for (const WantedColumn& column : wanted) places.push_back(table.column(column.name));
  auto rows = std::make_shared<TableRows<T>>();
  rows->file = file;
  rows->samples.resize(table.size());
  rows->verdicts.resize(table.size());
  std::vector<Time> stamps(table.size(), start);
  std::vector<double> values(wanted.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    T& sample = rows->samples[i];
    try {
      stamps[i] = clock.stamp(i, start);
      sample.stamp = sample.available = stamps[i];
      sample.sequence = i;
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        values[k] = wanted[k].unit * table.row(i)[places[k]];
        if (!(values[k] >= wanted[k].least && values[k] <= wanted[k].most)) {
          throw std::invalid_argument(wanted[k].name +
                                      " is out of range: " + std::to_string(values[k]));
        }
      }
      fill(TableValues(values), sample);
    } catch (const std::invalid_argument& e) {
      rows->verdicts[i] = Finding{file.string(), table.line(i), e.what()};
    }
  }
  refuse_out_of_order(stamps, file, rows->verdicts);
  return rows;
}

}  // namespace maploop::sensors
