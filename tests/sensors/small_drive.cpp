#include "tests/sensors/small_drive.h"

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "msgs/time.h"
#include "sensors/image/png.h"
#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

std::string stamps(Duration offset) {
  std::string text;
  const Time first = parse_time("2011-09-26 13:10:51") + offset;
  for (std::size_t i = 0; i < SmallDrive::frames; ++i) {
    text += format_time(first + static_cast<int>(i) * std::chrono::milliseconds(100)) + "\n";
  }
  return text;
}

std::string png(std::size_t frame, int camera) {
  std::vector<std::uint8_t> pixels;
  for (int v = 0; v < SmallDrive::height; ++v) {
    for (int u = 0; u < SmallDrive::width; ++u) {
      pixels.push_back(
          static_cast<std::uint8_t>(7 * u + 31 * v + 50 * camera + static_cast<int>(frame)));
    }
  }
  const std::vector<std::uint8_t> bytes = encode_png(pixels, SmallDrive::width, SmallDrive::height);
  return {bytes.begin(), bytes.end()};
}

std::string scan() {
  std::string bytes;
  for (std::size_t i = 0; i < SmallDrive::points; ++i) {
    const float point[4] = {static_cast<float>(i), 2.0F, -1.5F, 0.25F};
    bytes.append(reinterpret_cast<const char*>(point), sizeof(point));
  }
  return bytes;
}

}  // namespace

std::string oxts_row_text() {
  return "49.013141872681 8.4378138518088 114.06644439697 -0.000229 0.009947 1.8456953267949 "
         "11.375996992995 -3.290687456108 11.842084178285 -0.083632098803428 0.040323535587709 "
         "-0.43999459306673 0.088955239453583 9.663174859472 -0.35754827095883 0.090143876653998 "
         "9.6666150394393 -0.0022083457830958 0.025055454998679 0.0062110895146255 "
         "-0.0021447310313027 0.025057189512882 0.006226415927148 0.14961617559609 "
         "0.031827660925679 4 8 4 4 0\n";
}

std::string cam_to_cam_text() {
  return "calib_time: 09-Jan-2012 13:57:47\n"
         "corner_dist: 9.950000e-02\n"
         "S_00: 1.392000e+03 5.120000e+02\n"
         "S_rect_00: 3.200000e+01 2.400000e+01\n"
         "R_rect_00: 9.999239e-01 9.837760e-03 -7.445048e-03 -9.869795e-03 9.999421e-01 "
         "-4.278459e-03 7.402527e-03 4.351614e-03 9.999631e-01\n"
         "P_rect_00: 7.215377e+02 0.000000e+00 6.095593e+02 0.000000e+00 0.000000e+00 "
         "7.215377e+02 1.728540e+02 0.000000e+00 0.000000e+00 0.000000e+00 1.000000e+00 "
         "0.000000e+00\n"
         "S_rect_01: 3.200000e+01 2.400000e+01\n"
         "P_rect_01: 7.215377e+02 0.000000e+00 6.095593e+02 -3.875744e+02 0.000000e+00 "
         "7.215377e+02 1.728540e+02 0.000000e+00 0.000000e+00 0.000000e+00 1.000000e+00 "
         "0.000000e+00\n";
}

std::string velo_to_cam_text() {
  return "calib_time: 15-Mar-2012 11:37:16\n"
         "R: 7.533745e-03 -9.999714e-01 -6.166020e-04 1.480249e-02 7.280733e-04 -9.998902e-01 "
         "9.998621e-01 7.523790e-03 1.480755e-02\n"
         "T: -4.069766e-03 -7.631618e-02 -2.717806e-01\n"
         "delta_f: 0.000000e+00 0.000000e+00\n"
         "delta_c: 0.000000e+00 0.000000e+00\n";
}

std::string imu_to_velo_text() {
  return "calib_time: 25-May-2012 16:47:16\n"
         "R: 9.999976e-01 7.553071e-04 -2.035826e-03 -7.854027e-04 9.998898e-01 -1.482298e-02 "
         "2.024406e-03 1.482454e-02 9.998881e-01\n"
         "T: -8.086759e-01 3.195559e-01 -7.997231e-01\n";
}

SmallDrive::SmallDrive() {
  using std::chrono::milliseconds;
  for (const char* sensor : {"image_00", "image_01", "velodyne_points", "oxts"}) {
    std::filesystem::create_directories(folder() / sensor / "data");
  }
  write("../calib_cam_to_cam.txt", cam_to_cam_text());
  write("../calib_velo_to_cam.txt", velo_to_cam_text());
  write("../calib_imu_to_velo.txt", imu_to_velo_text());
  write("image_00/timestamps.txt", stamps(milliseconds(0)));
  write("image_01/timestamps.txt", stamps(milliseconds(2)));
  write("velodyne_points/timestamps_start.txt", stamps(milliseconds(-70)));
  write("velodyne_points/timestamps.txt", stamps(milliseconds(-20)));
  write("velodyne_points/timestamps_end.txt", stamps(milliseconds(30)));
  write("oxts/timestamps.txt", stamps(milliseconds(1)));
  for (std::size_t i = 0; i < frames; ++i) {
    write("image_00/data/" + numbered_file(i, ".png"), png(i, 0));
    write("image_01/data/" + numbered_file(i, ".png"), png(i, 1));
    write("velodyne_points/data/" + numbered_file(i, ".bin"), scan());
    write("oxts/data/" + numbered_file(i, ".txt"), oxts_row_text());
  }
}

std::string SmallDrive::read(const std::string& file) const {
  std::ifstream stream(folder() / file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void SmallDrive::write(const std::string& file, const std::string& content) const {
  std::ofstream stream(folder() / file, std::ios::binary);
  stream << content;
  if (!stream.flush()) throw std::runtime_error("cannot write " + file);
}

void SmallDrive::write_line(const std::string& file, std::size_t line,
                            const std::string& content) const {
  std::istringstream before(read(file));
  std::string after;
  std::string text;
  for (std::size_t number = 1; std::getline(before, text); ++number) {
    after += (number == line ? content : text) + "\n";
  }
  write(file, after);
}

void SmallDrive::remove(const std::string& file) const {
  if (std::filesystem::remove_all(folder() / file) == 0) {
    throw std::runtime_error("nothing to remove: " + file);
  }
}

}  // namespace maploop::sensors
