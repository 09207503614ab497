#include "sensors/folder/table_reader.h"

#include <cmath>

#include "msgs/frames.h"
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

constexpr double most_height = 20e3;   // m
constexpr double most_radius = 6.5e6;  // m from the Earth's centre

Eigen::Vector3d vector_of(TableValues v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

void want(std::vector<WantedColumn>& wanted, const Columns& columns, double least, double most) {
  for (const std::string& name : columns.names) wanted.push_back({name, columns.unit, least, most});
}

void want_position(std::vector<WantedColumn>& wanted, PositionForm form, const Columns& c) {
  if (form == PositionForm::geodetic) {
    wanted.push_back({c.names[0], c.unit, -90.0, 90.0});
    wanted.push_back({c.names[1], c.unit, -180.0, 180.0});
    wanted.push_back({c.names[2], 1.0, -most_height, most_height});
  } else {
    want(wanted, c, -most_radius, most_radius);
  }
}

Geodetic place(PositionForm form, TableValues v) {
  // At the equator's zero, east, north and up are Earth's y, z and x.
  constexpr double equator = 6378137.0;  // m
  if (form == PositionForm::local) return LocalFrame().to_geodetic(vector_of(v));
  if (form == PositionForm::geodetic) return {radians(v[0]), radians(v[1]), v[2]};
  if (vector_of(v).norm() < 6.3e6) throw std::invalid_argument("the position is not on Earth");
  return LocalFrame().to_geodetic({v[1], v[2], v[0] - equator});
}

Eigen::Vector3d velocity_enu(VelocityAxes axes, TableValues v, const Geodetic& at) {
  if (axes == VelocityAxes::ned) return {v[1], v[0], -v[2]};
  if (axes == VelocityAxes::enu) return vector_of(v);
  const double sp = std::sin(at.latitude), cp = std::cos(at.latitude);
  const double sl = std::sin(at.longitude), cl = std::cos(at.longitude);
  Eigen::Matrix3d R_enu_ecef;
  R_enu_ecef << -sl, cl, 0.0, -sp * cl, -sp * sl, cp, cp * cl, cp * sl, sp;
  return R_enu_ecef * vector_of(v);
}

// The tables of sensors/FORMATS.md have a number in each cell.
OpenedTable::OpenedTable(const TableFile& file, const TableMapping& mapping)
    : table(file.file, {file.columns, file.time.at(0), file.time.at(0) != "t_s"}),
      clock(table, file, mapping.utc_of_gps) {}

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
