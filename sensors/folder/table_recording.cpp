#include "sensors/folder/table_recording.h"

#include <array>
#include <iomanip>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "msgs/median.h"
#include "sensors/folder/table_reader.h"
#include "sensors/gnss/velocity_from_positions.h"
#include "sensors/replay/sequence_files.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

constexpr double most_sigma = 1e6;    // m, m/s
constexpr double most_rate = 40.0;    // rad/s
constexpr double most_force = 400.0;  // m/s^2

Eigen::Matrix3d covariance(TableValues north_east_down) {
  return Eigen::Vector3d(north_east_down[1], north_east_down[0], -north_east_down[2])
      .cwiseAbs2()
      .asDiagonal();
}

// Takes a standard deviation of `usual` for those axes (north, east, down) of which none is stated,
// or 0, as receivers do that do not know.
Eigen::Matrix3d covariance_or(TableValues stated, std::array<double, 3> usual) {
  for (std::size_t i = 0; i < stated.size(); ++i)
    if (stated[i] > 0.0) usual[i] = stated[i];
  return covariance(usual);
}

std::shared_ptr<TableRows<GnssFix>> read_fixes(const OpenedTable& opened, const GnssTable& t,
                                               Time start) {
  std::vector<WantedColumn> wanted;
  want_position(wanted, t.form, t.position);
  want(wanted, t.velocity, -fastest_receiver, fastest_receiver);
  want(wanted, t.position_sigma, 0.0, most_sigma);
  want(wanted, t.velocity_sigma, 0.0, most_sigma);
  want(wanted, t.quality, -1e9, 1e9);
  const auto fill = [&](TableValues v, GnssFix& fix) {
    constexpr double height_share = 1.5;  // heights are worse than the horizontal position
    const auto take = [&v](const Columns& columns) {
      const TableValues taken = v.first(columns.names.size());
      v = v.subspan(columns.names.size());
      return taken;
    };
    fix.position = place(t.form, take(t.position));
    const TableValues velocity = take(t.velocity), position_sigma = take(t.position_sigma),
                      velocity_sigma = take(t.velocity_sigma);
    if (t.quality.given() && v[0] == 0.0) throw std::invalid_argument("the receiver had no fix");
    const double p = t.default_position_sigma, s = t.default_velocity_sigma;
    fix.position_covariance = covariance_or(position_sigma, {p, p, height_share * p});
    fix.velocity_stamp = fix.stamp;
    if (!t.velocity.given()) return;
    fix.velocity_enu = velocity_enu(t.velocity_axes, velocity, fix.position);
    fix.velocity_covariance = covariance_or(velocity_sigma, {s, s, s});
  };
  auto rows = read_rows<GnssFix>(opened.table, opened.clock, start, wanted, fill);
  VelocityFromPositions derivative;
  for (std::size_t i = 0; i < rows->samples.size() && !t.velocity.given(); ++i)
    if (!rows->verdicts[i]) derivative.set_velocity(rows->samples[i]);
  return rows;
}

// Gravity is in every specific force of a vehicle, and no vehicle turns for long as fast as numbers
// in degrees say.
void require_units(const TableRows<SixAxisSample>& rows) {
  constexpr std::size_t enough = 200;
  constexpr double least_gravity = 7.0, most_gravity = 13.0;  // m/s^2, in the median
  constexpr double fast_turning = 4.0;                        // rad/s, in the 99th percentile
  std::vector<double> forces, rates;
  for (std::size_t i = 0; i < rows.samples.size(); ++i) {
    if (rows.verdicts[i]) continue;
    forces.push_back(rows.samples[i].force.norm());
    rates.push_back(rows.samples[i].rate.norm());
  }
  if (forces.size() < enough) return;
  const auto refuse = [&](double value, const char* what, const char* unit) {
    std::ostringstream text;
    text << rows.file.string() << ": " << std::setprecision(3) << value << what << unit
         << ", sensors/FORMATS.md)";
    throw std::runtime_error(text.str());
  };
  const double force = median(forces), rate = quantile(rates, 0.99);
  if (force < least_gravity || force > most_gravity) {
    refuse(force,
           " m/s^2 is the specific force in the median, where gravity alone is 9.8; give forces "
           "with gravity, and state their unit (",
           "accelerometer_unit");
  }
  if (rate > fast_turning) {
    refuse(rate,
           " rad/s or more in 1 % of the rows is faster than a vehicle turns; state the unit (",
           "gyro_unit");
  }
}

std::shared_ptr<TableRows<SixAxisSample>> read_imu(const OpenedTable& opened, const ImuTable& t,
                                                   Time start) {
  std::vector<WantedColumn> wanted;
  want(wanted, t.gyro, -most_rate, most_rate);
  want(wanted, t.accelerometer, -most_force, most_force);
  auto rows = read_rows<SixAxisSample>(opened.table, opened.clock, start, wanted,
                                       [](TableValues v, SixAxisSample& sample) {
                                         sample.rate = {v[0], v[1], v[2]};
                                         sample.force = {v[3], v[4], v[5]};
                                       });
  require_units(*rows);
  return rows;
}

std::shared_ptr<TableRows<WheelSpeed>> read_wheel(const OpenedTable& opened, const WheelTable& t,
                                                  Time start) {
  std::vector<WantedColumn> wanted;
  want(wanted, t.speed, -fastest_receiver, fastest_receiver);
  return read_rows<WheelSpeed>(opened.table, opened.clock, start, wanted,
                               [&t](TableValues v, WheelSpeed& sample) {
                                 sample.speed = v[0];
                                 sample.sigma = t.sigma;
                               });
}

// The reason is that of the first row, which the others mostly share.
template <class T>
void require_a_row(const TableRows<T>& rows) {
  if (rows.first() != nullptr) return;
  throw std::runtime_error(rows.file.string() + ": has no row that can be used: " +
                           (rows.verdicts.empty() ? "it is empty" : rows.verdicts[0]->reason));
}

const fs::path& with_fixes(const fs::path& folder) {
  if (existing_table(folder / "gnss.csv")) return folder;
  throw std::runtime_error("'" + folder.string() +
                           "' has no gnss.csv or gnss.csv.gz: a drive needs the fixes of a GNSS "
                           "receiver to have a position (sensors/FORMATS.md)");
}

}  // namespace

TableMapping plain_tables(const fs::path& folder) {
  const auto file_of = [&](const char* name) {
    TableFile file;
    file.file = existing_table(folder / name).value_or("");
    file.time = {"t_s"};
    return file;
  };
  TableMapping m;
  const Columns position{{"lat_deg", "lon_deg", "height_m"}};
  const Columns velocity{{"vn_mps", "ve_mps", "vd_mps"}};
  static_cast<TableFile&>(m.gnss) = file_of("gnss.csv");
  m.gnss.position = position;
  m.gnss.velocity = velocity;
  m.gnss.position_sigma = {{"pos_std_n_m", "pos_std_e_m", "pos_std_d_m"}};
  m.gnss.velocity_sigma = {{"vel_std_n_mps", "vel_std_e_mps", "vel_std_d_mps"}};
  static_cast<TableFile&>(m.imu) = file_of("imu.csv");
  m.imu.gyro = {{"gx_radps", "gy_radps", "gz_radps"}};
  m.imu.accelerometer = {{"ax_mps2", "ay_mps2", "az_mps2"}};
  m.reference.attitude_file = file_of("reference_attitude.csv");
  if (m.reference.attitude_file.given())
    static_cast<TableFile&>(m.reference) = file_of("reference_position.csv");
  m.reference.position = position;
  m.reference.velocity = velocity;
  m.reference.attitude = {{"roll_deg", "pitch_deg", "yaw_deg"}};
  return m;
}

bool TableRecording::is_named(const fs::path& path) {
  return existing_table(path / "gnss.csv") || existing_table(path / "imu.csv");
}

TableRecording::TableRecording(const fs::path& folder)
    : TableRecording(plain_tables(with_fixes(folder))) {}

TableRecording::TableRecording(const TableMapping& mapping) {
  std::optional<Time> start;  // that of the first table; all have one clock
  const auto read = [&](const auto& table, auto& rows, auto reader) {
    if (!table.given()) return;
    const OpenedTable opened(table, mapping);
    if (!start) start = opened.clock.start();
    rows = reader(opened, table, *start);
    require_a_row(*rows);
  };
  read(mapping.gnss, gnss_, read_fixes);
  read(mapping.imu, imu_, read_imu);
  read(mapping.wheel, wheel_, read_wheel);
  if (mapping.reference.given()) reference_ = read_reference(mapping, start);
}

template <class F>
auto TableRecording::of_main_table(F f) const {
  if (gnss_ != nullptr) return f(*gnss_);
  if (wheel_ != nullptr) return f(*wheel_);
  if (imu_ != nullptr) return f(*imu_);
  throw std::logic_error("the recording has no table");
}

std::size_t TableRecording::fix_count() const {
  return of_main_table([](const auto& rows) { return rows.samples.size(); });
}

Time TableRecording::first_stamp() const {
  return of_main_table([](const auto& rows) { return rows.first()->stamp; });
}

Time TableRecording::last_stamp() const {
  return of_main_table([](const auto& rows) { return rows.last()->stamp; });
}

std::unique_ptr<Source<GnssFix>> TableRecording::gnss() const {
  if (gnss_ == nullptr) return nullptr;
  return source_of(gnss_);
}

std::unique_ptr<Source<WheelSpeed>> TableRecording::wheel() const {
  if (wheel_ == nullptr) return nullptr;
  return source_of(wheel_);
}

std::unique_ptr<AlignedImu> TableRecording::imu(std::unique_ptr<Source<GnssFix>> fixes,
                                                const MountParameters& parameters,
                                                double rear_axle_distance) const {
  if (imu_ == nullptr) throw std::runtime_error("the drive has no imu.csv");
  return std::make_unique<AlignedImu>(source_of(imu_), std::move(fixes), parameters,
                                      rear_axle_distance, imu_->file);
}

std::unique_ptr<Source<ReferencePose>> TableRecording::reference() const {
  if (reference_ == nullptr) return nullptr;
  return source_of(reference_);
}

}  // namespace maploop::sensors
