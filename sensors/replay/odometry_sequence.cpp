#include "sensors/replay/odometry_sequence.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "sensors/folder/number_table.h"
#include "sensors/replay/files.h"
#include "sensors/replay/kitti_calibration.h"
#include "sensors/replay/sequence_files.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

// Refuses the rows inside each gap. The rows at its ends are real, except for a first row at the
// start of the recording.
void leave_out_gaps(const fs::path& file, OxtsRows& rows) {
  const NumberTable gaps(file);
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
  const NumberTable table(file);
  if (table.column("t") != 0 || table.column("orimode") != 30) {
    throw std::runtime_error(file.string() + ": the columns must be t and the 30 of OXTS");
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

// Only the inertial columns of these rows are filled.
OxtsRows read_imu_rows(const fs::path& file, Time start) {
  const NumberTable table(file);
  const std::size_t t = table.column("t"), ax = table.column("ax"), ay = table.column("ay"),
                    wz = table.column("wz"), interpolated = table.column("interpolated");
  const bool six = table.has("az") && table.has("wx") && table.has("wy");
  OxtsRows result;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto values = table.row(i);
    result.stamps.push_back(start);
    OxtsRow& row = result.rows.emplace_back();
    row.inertial = {values[ax], values[ay], values[wz]};
    if (six) {
      row.inertial.six_axes = true;
      row.inertial.specific_force_up = values[table.column("az")];
      row.inertial.roll_rate = values[table.column("wx")];
      row.inertial.pitch_rate = values[table.column("wy")];
    }
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
      if (numbers.size() != 1) throw std::invalid_argument("a line must contain one number");
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
  return stamps;
}

// A drive without image stamps gets one at each usable row.
std::vector<Time> stamps_of(const OxtsRows& rows) {
  std::vector<Time> stamps;
  for (std::size_t i = 0; i < rows.stamps.size(); ++i) {
    if (!rows.verdicts[i]) stamps.push_back(rows.stamps[i]);
  }
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
  describe_kitti_car(calibration);
  return calibration;
}

}  // namespace

bool OdometrySequence::is_named(const fs::path& path) {
  return find_sequence(path).has_value();
}

OdometrySequence::OdometrySequence(const fs::path& path, const KittiDriveParameters& parameters)
    : OxtsRecording(path.string(), from_seconds(parameters.imu_delay)), calibration_(axes_alone()) {
  const std::optional<SequenceFiles> files = find_sequence(path);
  if (!files) {
    throw std::runtime_error("no odometry sequence at '" + path.string() +
                             "': name a table of t and the 30 columns of OXTS, such as "
                             "kitti_odometry/oxts/06.csv.gz (sensors/FORMATS.md)");
  }
  auto rows = std::make_shared<OxtsRows>(read_rows(files->table, files->start));
  image_stamps_ = files->times ? read_image_stamps(*files->times, files->start) : stamps_of(*rows);
  if (files->gaps) leave_out_gaps(*files->gaps, *rows);
  if (image_stamps_.size() < 2) {
    throw std::runtime_error(files->times.value_or(files->table).string() +
                             ": contains fewer than two images");
  }
  set_rows(rows, files->imu
                     ? std::make_shared<const OxtsRows>(read_imu_rows(*files->imu, files->start))
                     : rows);
  labels_ = files->labels;
  tracks_ = files->tracks;
}

}  // namespace maploop::sensors
