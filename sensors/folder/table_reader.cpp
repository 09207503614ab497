#include "sensors/folder/table_reader.h"

#include <cmath>

#include "sensors/replay/sequence_files.h"

namespace maploop::sensors {
namespace {

constexpr double seconds_of(TimeUnit unit) {
  switch (unit) {
    case TimeUnit::ms:
      return 1e-3;
    case TimeUnit::us:
      return 1e-6;
    case TimeUnit::ns:
      return 1e-9;
    default:
      return 1.0;
  }
}

}  // namespace

void want(std::vector<WantedColumn>& wanted, const Columns& columns, double least, double most) {
  for (const std::string& name : columns.names) wanted.push_back({name, columns.unit, least, most});
}

NumberTable open_table(const TableFile& file) {
  // The tables of sensors/FORMATS.md have a number in each cell.
  return NumberTable(file.file, {file.columns, file.time.at(0), file.time.at(0) != "t_s"});
}

TableClock::TableClock(const NumberTable& table, const TableFile& file, Time (*utc_of_gps)(Time))
    : table_(table), file_(file), utc_of_gps_(utc_of_gps) {
  for (const std::string& name : file.time) columns_.push_back(table.column(name));
  if (columns_.size() != (file.time_unit == TimeUnit::gps_week ? 2U : 1U)) {
    throw std::runtime_error(file.file.string() +
                             ": time needs one column, or those of the week and the second if the "
                             "unit is \"gps week\"");
  }
}

double TableClock::seconds(std::size_t row) const {
  constexpr double gps_epoch = 315964800.0, week = 604800.0;
  const auto cells = table_.row(row);
  if (file_.time_unit == TimeUnit::gps_week)
    return gps_epoch + week * cells[columns_[0]] + cells[columns_[1]];
  return seconds_of(file_.time_unit) * cells[columns_[0]];
}

Time TableClock::start() const {
  return table_.size() > 0 ? start_of_seconds(seconds(0)) : Time{};
}

Time TableClock::stamp(std::size_t row, Time start) const {
  const Duration since = checked_seconds(seconds(row));
  Time stamp = start + since;
  const std::int64_t whole = table_.whole(row);
  // The double of seconds is checked; whole units are exact.
  if (whole != NumberTable::none && file_.time_unit != TimeUnit::gps_week &&
      file_.time_unit != TimeUnit::s) {
    const auto unit = static_cast<std::int64_t>(std::lround(1e9 * seconds_of(file_.time_unit)));
    stamp = start + Duration(whole * unit);
  }
  const bool gps = file_.gps_time || file_.time_unit == TimeUnit::gps_week;
  return gps && utc_of_gps_ != nullptr ? utc_of_gps_(stamp) : stamp;
}

}  // namespace maploop::sensors
