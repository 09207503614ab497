#include "sensors/folder/table_recording.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "msgs/frames.h"
#include "msgs/input_limits.h"
#include "sensors/folder/table_reader.h"
#include "sensors/gnss/velocity_from_positions.h"
#include "sensors/replay/sequence_files.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

constexpr double fastest = 515.0;      // m/s, where receivers stop
constexpr double most_sigma = 1e6;     // m, m/s
constexpr double most_rate = 40.0;     // rad/s
constexpr double most_force = 400.0;   // m/s^2
constexpr double most_height = 20e3;   // m
constexpr double most_radius = 6.5e6;  // m from the Earth's centre

// Appends the columns of a position.
void add_position(std::vector<WantedColumn>& wanted, PositionForm form, const Columns& c) {
  if (form == PositionForm::geodetic) {
    wanted.push_back({c.names[0], c.unit, -90.0, 90.0});
    wanted.push_back({c.names[1], c.unit, -180.0, 180.0});
    wanted.push_back({c.names[2], 1.0, -most_height, most_height});
  } else {
    want(wanted, c, -most_radius, most_radius);
  }
}

Eigen::Vector3d vector_of(TableValues v) {
  return {v[0], v[1], v[2]};
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

Eigen::Matrix3d covariance(TableValues north_east_down) {
  return Eigen::Vector3d(north_east_down[1], north_east_down[0], -north_east_down[2])
      .cwiseAbs2()
      .asDiagonal();
}

struct OpenedTable {
  OpenedTable(const TableFile& file, const TableMapping& mapping)
      : table(open_table(file)), clock(table, file, mapping.utc_of_gps) {}
  NumberTable table;
  TableClock clock;
};

std::shared_ptr<TableRows<GnssFix>> read_fixes(const OpenedTable& opened, const GnssTable& t,
                                               Time start) {
  std::vector<WantedColumn> wanted;
  add_position(wanted, t.form, t.position);
  want(wanted, t.velocity, -fastest, fastest);
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
    fix.position_covariance = t.position_sigma.given()
                                  ? covariance(position_sigma)
                                  : covariance(std::array{p, p, height_share * p});
    fix.velocity_stamp = fix.stamp;
    if (!t.velocity.given()) return;
    fix.velocity_enu = velocity_enu(t.velocity_axes, velocity, fix.position);
    fix.velocity_covariance =
        t.velocity_sigma.given() ? covariance(velocity_sigma) : covariance(std::array{s, s, s});
  };
  auto rows = read_rows<GnssFix>(opened.table, opened.clock, start, wanted, fill);
  VelocityFromPositions derivative;
  for (std::size_t i = 0; i < rows->samples.size() && !t.velocity.given(); ++i)
    if (!rows->verdicts[i]) derivative.set_velocity(rows->samples[i]);
  return rows;
}

std::shared_ptr<TableRows<SixAxisSample>> read_imu(const OpenedTable& opened, const ImuTable& t,
                                                   Time start) {
  std::vector<WantedColumn> wanted;
  want(wanted, t.gyro, -most_rate, most_rate);
  want(wanted, t.accelerometer, -most_force, most_force);
  return read_rows<SixAxisSample>(opened.table, opened.clock, start, wanted,
                                  [](TableValues v, SixAxisSample& sample) {
                                    sample.rate = {v[0], v[1], v[2]};
                                    sample.force = {v[3], v[4], v[5]};
                                  });
}

std::shared_ptr<TableRows<WheelSpeed>> read_wheel(const OpenedTable& opened, const WheelTable& t,
                                                  Time start) {
  std::vector<WantedColumn> wanted;
  want(wanted, t.speed, -fastest, fastest);
  return read_rows<WheelSpeed>(opened.table, opened.clock, start, wanted,
                               [&t](TableValues v, WheelSpeed& sample) {
                                 sample.speed = v[0];
                                 sample.sigma = t.sigma;
                               });
}

// Refuses positions that no vehicle can come from and go on to.
void leave_out_leaps(TableRows<ReferencePose>& rows, const NumberTable& table) {
  constexpr double fastest_car = 100.0, noise = 10.0;  // m/s, m
  const auto leaps = [&](const ReferencePose& a, const ReferencePose& b) {
    const double way = LocalFrame(a.position).to_enu(b.position).head<2>().norm();
    return way > noise + fastest_car * std::abs(to_seconds(b.stamp - a.stamp));
  };
  for (std::size_t i = 1; i + 1 < rows.samples.size(); ++i) {
    const ReferencePose& pose = rows.samples[i];
    const bool judged = !rows.verdicts[i - 1] && !rows.verdicts[i] && !rows.verdicts[i + 1];
    if (judged && leaps(rows.samples[i - 1], pose) && leaps(pose, rows.samples[i + 1])) {
      rows.verdicts[i] =
          Finding{rows.file.string(), table.line(i), "the position leaps there and back"};
    }
  }
}

// Gives each position the attitude of its time.
void join(TableRows<ReferencePose>& poses, const NumberTable& table,
          const TableRows<ReferencePose>& attitudes) {
  constexpr Duration apart = std::chrono::milliseconds(20);  // at most
  std::vector<const ReferencePose*> known;
  for (std::size_t i = 0; i < attitudes.samples.size(); ++i) {
    if (!attitudes.verdicts[i]) known.push_back(&attitudes.samples[i]);
  }
  const auto earlier = [](const ReferencePose* a, Time t) { return a->stamp < t; };
  for (std::size_t i = 0; i < poses.samples.size(); ++i) {
    if (poses.verdicts[i]) continue;
    ReferencePose& pose = poses.samples[i];
    const auto after = std::lower_bound(known.begin(), known.end(), pose.stamp, earlier);
    const auto is_near = [&](const ReferencePose* a) {
      return input_limits::within(apart, a->stamp, pose.stamp);
    };
    if (after != known.end() && is_near(*after)) {
      pose.attitude = (*after)->attitude;
    } else if (after != known.begin() && is_near(*(after - 1))) {
      pose.attitude = (*(after - 1))->attitude;
    } else {
      poses.verdicts[i] =
          Finding{poses.file.string(), table.line(i), "has no attitude at its time"};
    }
  }
}

void add_attitude(std::vector<WantedColumn>& wanted, const ReferenceTable& t) {
  if (t.quaternion.given()) return want(wanted, t.quaternion, -1.01, 1.01);
  constexpr std::array<double, 3> most{180.0, 90.0, 360.0};
  for (std::size_t k = 0; k < t.attitude.names.size(); ++k)
    wanted.push_back({t.attitude.names[k], t.attitude.unit, -most[k], most[k]});
}

void set_attitude(const ReferenceTable& t, TableValues v, ReferencePose& pose) {
  if (t.quaternion.given()) {
    const Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
    if (std::abs(q.norm() - 1.0) > 0.01)
      throw std::invalid_argument("the quaternion is not a unit");
    pose.attitude = attitude_from_rotation(q.normalized().toRotationMatrix() * t.R_unit_body);
    return;
  }
  // A receiver that has not aligned its unit states zeros.
  if (v[0] == 0.0 && v[2] == 0.0) throw std::invalid_argument("the receiver had not aligned yet");
  pose.attitude = {wrap_angle(radians(v[2])), radians(v[1]), radians(v[0])};
}

// Returns nullptr if the receiver never started its fusion.
std::shared_ptr<const TableRows<ReferencePose>> read_reference(const TableMapping& mapping,
                                                               std::optional<Time>& start) {
  const ReferenceTable& t = mapping.reference;
  const OpenedTable opened(t, mapping);
  if (!start) start = opened.clock.start();
  const bool joined = t.attitude_file.given();
  std::vector<WantedColumn> wanted, turned;
  add_position(wanted, t.form, t.position);
  want(wanted, t.velocity, -fastest, fastest);
  add_attitude(joined ? turned : wanted, t);
  const auto fill = [&](TableValues v, ReferencePose& pose) {
    pose.position = place(t.form, v);
    v = v.subspan(3);
    pose.velocity_stamp = pose.stamp;
    pose.position_accuracy = t.accuracy;
    if (t.velocity.given()) {
      pose.velocity_enu = velocity_enu(t.velocity_axes, v, pose.position);
      v = v.subspan(3);
    }
    if (!joined) set_attitude(t, v, pose);
  };
  const auto poses = read_rows<ReferencePose>(opened.table, opened.clock, *start, wanted, fill);
  if (t.peer) leave_out_leaps(*poses, opened.table);
  if (joined) {
    const OpenedTable attitudes(t.attitude_file, mapping);
    join(*poses, opened.table,
         *read_rows<ReferencePose>(
             attitudes.table, attitudes.clock, *start, turned,
             [&](TableValues v, ReferencePose& pose) { set_attitude(t, v, pose); }));
  }
  return poses->first() != nullptr ? poses : nullptr;
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
  return gnss_ != nullptr ? source_of(gnss_) : nullptr;
}

std::unique_ptr<Source<WheelSpeed>> TableRecording::wheel() const {
  return wheel_ != nullptr ? source_of(wheel_) : nullptr;
}

std::unique_ptr<AlignedImu> TableRecording::imu(std::unique_ptr<Source<GnssFix>> fixes,
                                                const MountParameters& parameters,
                                                double rear_axle_distance) const {
  if (imu_ == nullptr) throw std::runtime_error("the drive has no imu.csv");
  return std::make_unique<AlignedImu>(source_of(imu_), std::move(fixes), parameters,
                                      rear_axle_distance, imu_->file);
}

std::unique_ptr<Source<ReferencePose>> TableRecording::reference() const {
  return reference_ != nullptr ? source_of(reference_) : nullptr;
}

}  // namespace maploop::sensors
