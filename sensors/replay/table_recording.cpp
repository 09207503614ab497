#include "sensors/replay/table_recording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "msgs/frames.h"
#include "msgs/input_limits.h"
#include "sensors/replay/csv_table.h"
#include "sensors/replay/sequence_files.h"
#include "sensors/replay/timestamps.h"

namespace maploop::sensors {

namespace fs = std::filesystem;

template <class T>
struct TableRows {
  fs::path file;
  std::vector<T> samples;
  Verdicts verdicts;  // one for each sample

  // Return the first and the last sample that can be used; nullptr: there is none.
  const T* first() const {
    const auto found = std::find_if(verdicts.begin(), verdicts.end(), is_none);
    return found == verdicts.end() ? nullptr
                                   : &samples[static_cast<std::size_t>(found - verdicts.begin())];
  }
  const T* last() const {
    const auto found = std::find_if(verdicts.rbegin(), verdicts.rend(), is_none);
    return found == verdicts.rend()
               ? nullptr
               : &samples[static_cast<std::size_t>(verdicts.rend() - found) - 1];
  }

 private:
  static bool is_none(const std::optional<Finding>& verdict) { return !verdict; }
};

namespace {

// The limits are beyond what a road vehicle or its sensors can do, so that a damaged number does
// not pass for a measurement.
struct TableColumn {
  const char* name;
  double least, most;
};

constexpr double fastest = 515.0;  // m/s, where receivers stop
constexpr auto gnss_columns = std::to_array<TableColumn>({{"lat_deg", -90.0, 90.0},
                                                          {"lon_deg", -180.0, 180.0},
                                                          {"height_m", -20e3, 20e3},
                                                          {"vn_mps", -fastest, fastest},
                                                          {"ve_mps", -fastest, fastest},
                                                          {"vd_mps", -fastest, fastest},
                                                          {"pos_std_n_m", 0.0, 1e6},
                                                          {"pos_std_e_m", 0.0, 1e6},
                                                          {"pos_std_d_m", 0.0, 1e6},
                                                          {"vel_std_n_mps", 0.0, 1e6},
                                                          {"vel_std_e_mps", 0.0, 1e6},
                                                          {"vel_std_d_mps", 0.0, 1e6}});
constexpr double most_rate = 40.0;    // rad/s
constexpr double most_force = 400.0;  // m/s^2
constexpr auto imu_columns = std::to_array<TableColumn>({{"gx_radps", -most_rate, most_rate},
                                                         {"gy_radps", -most_rate, most_rate},
                                                         {"gz_radps", -most_rate, most_rate},
                                                         {"ax_mps2", -most_force, most_force},
                                                         {"ay_mps2", -most_force, most_force},
                                                         {"az_mps2", -most_force, most_force}});
constexpr auto position_columns = std::span(gnss_columns).first<6>();
constexpr auto attitude_columns = std::to_array<TableColumn>(
    {{"roll_deg", -180.0, 180.0}, {"pitch_deg", -90.0, 90.0}, {"yaw_deg", -360.0, 360.0}});

// Values at the columns, in their order.
using Values = std::span<const double>;

Eigen::Vector3d east_north_up(Values north_east_down) {
  return {north_east_down[1], north_east_down[0], -north_east_down[2]};
}

Eigen::Matrix3d covariance(Values sigma_north_east_down) {
  return east_north_up(sigma_north_east_down).cwiseAbs2().asDiagonal();
}

Geodetic place(Values v) {
  return {radians(v[0]), radians(v[1]), v[2]};
}

void fill_fix(Values v, GnssFix& fix) {
  fix.position = place(v);
  fix.velocity_stamp = fix.stamp;
  fix.velocity_enu = east_north_up(v.subspan(3));
  fix.position_covariance = covariance(v.subspan(6));
  fix.velocity_covariance = covariance(v.subspan(9));
}

void fill_sample(Values v, SixAxisSample& sample) {
  sample.rate = {v[0], v[1], v[2]};
  sample.force = {v[3], v[4], v[5]};
}

void fill_position(Values v, ReferencePose& pose) {
  pose.position = place(v);
  pose.velocity_stamp = pose.stamp;
  pose.velocity_enu = east_north_up(v.subspan(3));
  pose.position_accuracy = TableRecording::reference_accuracy;
}

// A receiver that has not aligned its unit states zeros.
void fill_attitude(Values v, ReferencePose& pose) {
  if (v[0] == 0.0 && v[2] == 0.0) throw std::invalid_argument("the receiver had not aligned yet");
  pose.attitude = {wrap_angle(radians(v[2])), radians(v[1]), radians(v[0])};
}

// Refuses positions that no vehicle can come from and go on to.
void leave_out_leaps(TableRows<ReferencePose>& rows) {
  constexpr double fastest_car = 100.0, noise = 10.0;  // m/s, m
  const auto leaps = [&](const ReferencePose& a, const ReferencePose& b) {
    const double way = LocalFrame(a.position).to_enu(b.position).head<2>().norm();
    return way > noise + fastest_car * std::abs(to_seconds(b.stamp - a.stamp));
  };
  for (std::size_t i = 1; i + 1 < rows.samples.size(); ++i) {
    const ReferencePose& pose = rows.samples[i];
    const bool judged = !rows.verdicts[i - 1] && !rows.verdicts[i] && !rows.verdicts[i + 1];
    if (judged && leaps(rows.samples[i - 1], pose) && leaps(pose, rows.samples[i + 1])) {
      rows.verdicts[i] = Finding{rows.file.string(), i + 2, "the position leaps there and back"};
    }
  }
}

// Reads the columns of a table; fill(values, sample) makes a sample, which has its stamps, of the
// values in their order, or throws std::invalid_argument.
template <class T, class Fill>
std::shared_ptr<TableRows<T>> read(const CsvTable& table, Time start,
                                   std::span<const TableColumn> columns, Fill fill) {
  const fs::path& file = table.file();
  if (table.size() > input_limits::frames) {
    throw std::runtime_error(file.string() + ": has more than " +
                             std::to_string(input_limits::frames) + " rows; cut the drive");
  }
  const std::size_t t = table.column("t_s");
  std::vector<std::size_t> places;
  for (const TableColumn& column : columns) places.push_back(table.column(column.name));

  auto rows = std::make_shared<TableRows<T>>();
  rows->file = file;
  rows->samples.resize(table.size());
  rows->verdicts.resize(table.size());
  std::vector<Time> stamps(table.size(), start);
  std::vector<double> values(columns.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    T& sample = rows->samples[i];
    try {
      stamps[i] += checked_seconds(table.row(i)[t]);
      sample.stamp = sample.available = stamps[i];
      sample.sequence = i;
      for (std::size_t k = 0; k < columns.size(); ++k) {
        values[k] = table.row(i)[places[k]];
        if (values[k] < columns[k].least || values[k] > columns[k].most) {
          throw std::invalid_argument(std::string(columns[k].name) +
                                      " is out of range: " + std::to_string(values[k]));
        }
      }
      fill(Values(values), sample);
    } catch (const std::invalid_argument& e) {
      rows->verdicts[i] = Finding{file.string(), table.line(i), e.what()};
    }
  }
  refuse_out_of_order(stamps, file, rows->verdicts);
  return rows;
}

// The reason is that of the first row, which the others mostly share.
template <class T>
void require_a_row(const TableRows<T>& rows) {
  if (rows.first() != nullptr) return;
  throw std::runtime_error(rows.file.string() + ": has no row that can be used: " +
                           (rows.verdicts.empty() ? "it is empty" : rows.verdicts[0]->reason));
}

template <class T>
std::unique_ptr<Source<T>> source_of(std::shared_ptr<const TableRows<T>> rows) {
  return made<T>(
      [rows = std::move(rows), index = std::size_t{0}](T& sample, SourceReport& report) mutable {
        while (index < rows->samples.size()) {
          const std::size_t i = index++;
          if (!rows->verdicts[i]) {
            sample = rows->samples[i];
            return true;
          }
          report.refuse(*rows->verdicts[i]);
        }
        return false;
      });
}

// Gives each position the attitude of its time.
void join(TableRows<ReferencePose>& poses, const TableRows<ReferencePose>& attitudes) {
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
      poses.verdicts[i] = Finding{poses.file.string(), i + 2, "has no attitude at its time"};
    }
  }
}

// Returns nullptr if there is no reference, or if the receiver never started it.
std::shared_ptr<const TableRows<ReferencePose>> read_reference(const fs::path& folder, Time start) {
  const auto position = existing_table(folder / "reference_position.csv");
  const auto attitude = existing_table(folder / "reference_attitude.csv");
  if (!position || !attitude) return nullptr;
  const auto poses =
      read<ReferencePose>(CsvTable(*position), start, position_columns, fill_position);
  leave_out_leaps(*poses);
  join(*poses, *read<ReferencePose>(CsvTable(*attitude), start, attitude_columns, fill_attitude));
  return poses->first() != nullptr ? poses : nullptr;
}

}  // namespace

bool TableRecording::is_named(const fs::path& path) {
  return existing_table(path / "gnss.csv") || existing_table(path / "imu.csv");
}

TableRecording::TableRecording(const fs::path& folder) {
  const auto gnss = existing_table(folder / "gnss.csv");
  if (!gnss) {
    throw std::runtime_error("'" + folder.string() +
                             "' has no gnss.csv or gnss.csv.gz: a drive needs the fixes of a GNSS "
                             "receiver to have a position (sensors/FORMATS.md)");
  }
  const CsvTable fixes(*gnss);
  const Time start =
      fixes.size() > 0 ? start_of_seconds(fixes.row(0)[fixes.column("t_s")]) : Time{};
  gnss_ = read<GnssFix>(fixes, start, gnss_columns, fill_fix);
  require_a_row(*gnss_);
  if (const auto imu = existing_table(folder / "imu.csv")) {
    imu_ = read<SixAxisSample>(CsvTable(*imu), start, imu_columns, fill_sample);
    require_a_row(*imu_);
  }
  reference_ = read_reference(folder, start);
}

std::size_t TableRecording::fix_count() const {
  return gnss_->samples.size();
}

Time TableRecording::first_stamp() const {
  return gnss_->first()->stamp;
}

Time TableRecording::last_stamp() const {
  return gnss_->last()->stamp;
}

std::unique_ptr<Source<GnssFix>> TableRecording::gnss() const {
  return source_of(gnss_);
}

std::unique_ptr<AlignedImu> TableRecording::imu(std::unique_ptr<Source<GnssFix>> fixes,
                                                const MountParameters& parameters,
                                                double rear_axle_distance) const {
  if (imu_ == nullptr) throw std::runtime_error("the drive has no imu.csv");
  return std::make_unique<AlignedImu>(source_of(imu_), std::move(fixes), parameters,
                                      rear_axle_distance, imu_->file);
}

std::unique_ptr<Source<ReferencePose>> TableRecording::reference() const {
  if (reference_ == nullptr) throw std::runtime_error("the drive has no reference");
  return source_of(reference_);
}

}  // namespace maploop::sensors
