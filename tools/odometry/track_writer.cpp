#include "tools/odometry/track_writer.h"

#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/evaluate/text_file.h"

namespace maploop::odometry {

void write_recorded_tracks(const std::filesystem::path& file,
                           const vehicle::RecordedTracks& recorded) {
  const StereoCalibration& c = recorded.calibration;
  nlohmann::json meta{{"fx", c.fx},
                      {"fy", c.fy},
                      {"cu", c.cx},
                      {"cv", c.cy},
                      {"baseline_m", c.baseline},
                      {"first_good_frame", recorded.first_good_frame},
                      {"suspect_tracks", nlohmann::json::array()}};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      meta["T_imu_cam"][static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
          c.T_body_cam(row, column);
  for (const Time stamp : recorded.stamps)
    meta["timestamps"].push_back(to_seconds(stamp - recorded.stamps.front()));
  evaluation::write_text(vehicle::meta_beside(file), meta.dump(1) + "\n");

  std::ostringstream rows;
  rows << "frame,track,uL,vL,uR,vR\n" << std::fixed << std::setprecision(4);
  for (std::size_t frame = 0; frame < recorded.frames.size(); ++frame)
    for (const vehicle::RecordedTracks::Seen& seen : recorded.frames[frame])
      rows << frame << ',' << seen.id << ',' << seen.at.u_left << ',' << seen.at.v_left << ','
           << seen.at.u_right << ',' << seen.at.v_right << '\n';
  evaluation::write_text(file, rows.str());
}

}  // namespace maploop::odometry
