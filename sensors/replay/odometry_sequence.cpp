#include "sensors/replay/odometry_sequence.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "sensors/replay/csv_table.h"
#include "sensors/replay/files.h"
#include "sensors/replay/oxts_sources.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

// The raw drive of each sequence (KITTI's devkit) and the stamp of the first row of its table.
struct RawDrive {
  std::string_view sequence, day, number, first_row;
};
constexpr std::array<RawDrive, 8> raw_drives{{{"00", "2011_10_03", "0027", "12:55:34.997"},
                                              {"01", "2011_10_03", "0042", "14:34:18.654"},
                                              {"02", "2011_10_03", "0034", "13:55:41.717"},
                                              {"03", "2011_09_26", "0067", "15:00:00"},
                                              {"04", "2011_09_30", "0016", "11:50:40.354"},
                                              {"06", "2011_09_30", "0020", "12:08:26.521"},
                                              {"08", "2011_09_30", "0028", "12:44:36.118"},
                                              {"10", "2011_09_30", "0034", "13:16:05.640"}}};

// `name` or `name`.gz, whichever is there.
std::optional<fs::path> existing(const fs::path& name) {
  std::error_code ignored;
  if (fs::is_regular_file(name, ignored)) return name;
  const fs::path packed = name.string() + ".gz";
  if (fs::is_regular_file(packed, ignored)) return packed;
  return std::nullopt;
}

struct Name {
  fs::path folder;
  std::string number;
  fs::path oxts;
};

std::optional<Name> parse(const fs::path& path) {
  fs::path file = path;
  if (file.extension() == ".gz") file.replace_extension();
  Name name;
  if (file.extension() == ".csv" && file.parent_path().filename() == "oxts") {
    name = {file.parent_path().parent_path(), file.stem().string(), {}};
  } else {
    name = {path.parent_path(), path.filename().string(), {}};
  }
  const auto oxts = existing(name.folder / "oxts" / (name.number + ".csv"));
  if (!oxts) return std::nullopt;
  name.oxts = *oxts;
  return name;
}

fs::path required(const fs::path& name) {
  if (const auto found = existing(name)) return *found;
  throw std::runtime_error(name.string() + ": the file is missing (also as .gz)");
}

Time start_of(const RawDrive& drive) {
  std::string day(drive.day);
  std::replace(day.begin(), day.end(), '_', '-');
  return parse_time(day + ' ' + std::string(drive.first_row));
}

// Verdicts on the rows inside; its ends are real, but for a first row that begins the recording.
void leave_out_gaps(const fs::path& file, OxtsRows& rows) {
  const CsvTable gaps(file);
  const std::size_t first_row = gaps.column("first_row"), last_row = gaps.column("last_row");
  const auto number = [&rows](double cell) {
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(rows.rows.size())));
  };
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const std::size_t first = number(gaps.row(i)[first_row]), last = number(gaps.row(i)[last_row]);
    for (std::size_t r = first == 0 ? 0 : first + 1; r < last; ++r) {
      if (rows.verdicts[r]) continue;
      rows.verdicts[r] = Finding{file.string(), gaps.line(i), "invented: the recorder was silent"};
    }
  }
}

OxtsRows read_rows(const fs::path& file, Time start) {
  const CsvTable table(file);
  if (table.column("t") != 0 || table.column("orimode") != 30) {
    throw std::runtime_error(file.string() + ": not t and the 30 columns of OXTS");
  }
  OxtsRows result;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto values = table.row(i);
    result.stamps.push_back(start);
    result.rows.emplace_back();
    result.verdicts.emplace_back();
    try {
      result.stamps.back() += checked_seconds(values[0]);
      result.rows.back() = oxts_row(values.subspan(1));
    } catch (const std::invalid_argument& e) {
      result.verdicts.back() = Finding{file.string(), table.line(i), e.what()};
    }
  }
  refuse_out_of_order(result.stamps, file, result.verdicts);
  return result;
}

// Of these rows only the inertial columns are filled.
OxtsRows read_imu_rows(const fs::path& file, Time start) {
  const CsvTable table(file);
  const std::size_t t = table.column("t"), ax = table.column("ax"), ay = table.column("ay"),
                    wz = table.column("wz"), interpolated = table.column("interpolated");
  OxtsRows result;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto values = table.row(i);
    result.stamps.push_back(start);
    OxtsRow& row = result.rows.emplace_back();
    row.specific_force_forward = values[ax];
    row.specific_force_left = values[ay];
    row.yaw_rate = values[wz];
    result.verdicts.emplace_back();
    try {
      result.stamps.back() += checked_seconds(values[t]);
      if (values[interpolated] != 0.0)
        throw std::invalid_argument("invented: the recorder was silent");
    } catch (const std::invalid_argument& e) {
      result.verdicts.back() = Finding{file.string(), table.line(i), e.what()};
    }
  }
  refuse_out_of_order(result.stamps, file, result.verdicts);
  return result;
}

std::vector<Time> read_image_stamps(const fs::path& file, Time start) {
  std::vector<Time> stamps;
  const std::string text = read_text(file);
  for (const std::string_view line : split_lines(text)) {
    try {
      const std::vector<double> numbers = parse_numbers(line);
      if (numbers.size() != 1) throw std::invalid_argument("not one number");
      stamps.push_back(start + checked_seconds(numbers[0]));
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(file.string() + ":" + std::to_string(stamps.size() + 1) + ": " +
                               e.what());
    }
    if (stamps.size() > 1 && stamps.back() <= stamps[stamps.size() - 2]) {
      throw std::runtime_error(file.string() + ":" + std::to_string(stamps.size()) +
                               ": not later than the line before");
    }
  }
  if (stamps.size() < 2) throw std::runtime_error(file.string() + ": fewer than two images");
  return stamps;
}

VehicleCalibration axes_alone() {
  VehicleCalibration calibration;
  StereoCalibration& s = calibration.stereo;
  s.width = 1241;
  s.height = 376;
  s.fx = s.fy = 718.856;
  s.cx = 607.1928;
  s.cy = 185.2157;
  s.baseline = 0.5372;
  Eigen::Matrix3d R_body_cam;
  R_body_cam << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  s.T_body_cam.linear() = R_body_cam;
  return calibration;
}

}  // namespace

bool OdometrySequence::is_named(const fs::path& path) {
  return parse(path).has_value();
}

OdometrySequence::OdometrySequence(const fs::path& path, const KittiDriveParameters& parameters)
    : delay_(from_seconds(parameters.imu_delay)), calibration_(axes_alone()) {
  const std::optional<Name> name = parse(path);
  if (!name) {
    throw std::runtime_error("no odometry sequence at '" + path.string() +
                             "': name a table such as kitti_odometry/oxts/06.csv.gz");
  }
  const auto drive = std::find_if(raw_drives.begin(), raw_drives.end(),
                                  [&](const RawDrive& d) { return d.sequence == name->number; });
  if (drive == raw_drives.end()) {
    throw std::runtime_error(path.string() + ": the raw drive of sequence '" + name->number +
                             "' is not known; those known are 00 to 04, 06, 08 and 10");
  }
  const Time start = start_of(*drive);
  auto rows = std::make_shared<OxtsRows>(read_rows(name->oxts, start));
  if (const auto gaps = existing(name->folder / "oxts" / (name->number + ".gaps.csv"))) {
    leave_out_gaps(*gaps, *rows);
  }
  rows_ = imu_rows_ = std::move(rows);
  image_stamps_ =
      read_image_stamps(required(name->folder / "poses" / (name->number + ".times.txt")), start);

  const std::string day(drive->day), number(drive->number);
  if (const auto imu = existing(name->folder / "imu100" / (day + "_" + number + ".csv"))) {
    imu_rows_ = std::make_shared<const OxtsRows>(read_imu_rows(*imu, start));
  }
  labels_ = existing(name->folder / "labels" / (name->number + ".csv"));
  tracks_ = existing(name->folder / "tracks" / (day + "_drive_" + number + ".csv"));
}

std::unique_ptr<Source<ImuSample>> OdometrySequence::imu() const {
  return make_imu_source(imu_rows_, delay_);
}

std::unique_ptr<Source<GnssFix>> OdometrySequence::gnss(const GnssAidParameters& parameters) const {
  return make_gnss_source(rows_, delay_, parameters);
}

std::unique_ptr<Source<WheelSpeed>> OdometrySequence::wheel(
    const WheelOdometerParameters& parameters) const {
  return make_wheel_source(rows_, delay_, parameters);
}

std::unique_ptr<Source<ReferencePose>> OdometrySequence::reference() const {
  return make_reference_source(rows_, delay_);
}

}  // namespace maploop::sensors
