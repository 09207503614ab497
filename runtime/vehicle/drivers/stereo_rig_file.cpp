#include "runtime/vehicle/drivers/stereo_rig_file.h"

#include <Eigen/Dense>
#include <array>
#include <span>
#include <stdexcept>
#include <string_view>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "runtime/core/config.h"
#include "runtime/core/number_text.h"
#include "sensors/replay/kitti_calibration.h"

namespace maploop::vehicle {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr std::string_view to_distorted = "undistorted_to_distorted";
constexpr std::array directions{to_distorted, std::string_view("distorted_to_undistorted")};

// Reads or writes each value of the file, in its order: `to` is a Reader or a Writer, and Rig is
// const for a Writer.
template <class Rig, class To>
void each_value(Rig& rig, To& to) {
  to.number("width", rig.width);
  to.number("height", rig.height);
  for (auto [name, camera] : {std::pair("left", &rig.left), std::pair("right", &rig.right)}) {
    to.table(name);
    to.number("fx", camera->fx);
    to.number("fy", camera->fy);
    to.number("cx", camera->cx);
    to.number("cy", camera->cy);
    to.number("k1", camera->distortion.k1);
    to.number("k2", camera->distortion.k2);
    to.number("p1", camera->distortion.p1);
    to.number("p2", camera->distortion.p2);
    to.number("k3", camera->distortion.k3);
    to.optional("k4", camera->distortion.k4);
    to.optional("k5", camera->distortion.k5);
    to.optional("k6", camera->distortion.k6);
    to.lens(camera->distortion.lens);
    to.direction(*camera, rig);
  }
  to.table("extrinsics");
  to.rotation("R_right_left", rig.T_right_left.linear());
  to.vector("t_right_left", rig.T_right_left.translation());
  to.table("rectification");
  to.rotation("R_rect_left", rig.R_rect_left);
  to.rotation("R_rect_right", rig.R_rect_right);
  to.number("width", rig.rectified.width);
  to.number("height", rig.rectified.height);
  to.number("fx", rig.rectified.fx);
  to.number("fy", rig.rectified.fy);
  to.number("cx", rig.rectified.cx);
  to.number("cy", rig.rectified.cy);
  to.number("baseline", rig.rectified.baseline);
}

class Reader {
 public:
  explicit Reader(const runtime::ConfigTable& root) : root_(root), table_(root) {}

  void table(const char* name) { table_ = root_.table(name); }

  void number(const char* key, auto&& value) {
    if (!table_.has(key)) table_.fail(key, "is missing; a calibration needs every number");
    table_.read(key, value);
  }

  void optional(const char* key, double& value) { table_.read(key, value); }

  void lens(sensors::Lens& lens) {
    std::string name(to_string(lens));
    table_.read_one_of("lens", name, enum_names<sensors::Lens>);
    lens = *value_named<sensors::Lens>(name);
  }

  void vector(const char* key, auto&& value) {
    Eigen::Vector3d read;
    number(key, std::span<double>(read.data(), 3));
    value = read;
  }

  void rotation(const char* key, auto&& value) {
    RowMajor printed;
    number(key, std::span<double>(printed.data(), 9));
    const auto nearest = sensors::nearest_rotation(printed);
    if (!nearest) table_.fail(key, sensors::why_no_rotation(printed));
    value = *nearest;
  }

  void direction(sensors::CameraModel& camera, const sensors::StereoRig& rig) {
    std::string direction(to_distorted);
    table_.read_one_of("direction", direction, directions);
    if (direction == to_distorted) return;
    const sensors::Distortion& d = camera.distortion;
    if (d.lens != sensors::Lens::radial_tangential || d.k4 != 0.0 || d.k5 != 0.0 || d.k6 != 0.0)
      table_.fail("direction", "is for a radial-tangential lens without k4, k5 and k6");
    if (!(camera.fx > 0.0 && camera.fy > 0.0)) table_.fail("fx", "must be above 0");
    const auto converted = sensors::from_reversed(camera, rig.width, rig.height);
    constexpr double most = 0.5;  // px
    if (!(converted.largest_error < most)) {
      table_.fail("direction",
                  "cannot be approximated by undistorted_to_distorted coefficients better than " +
                      std::to_string(converted.largest_error) + " px");
    }
    camera.distortion = converted.distortion;
  }

 private:
  runtime::ConfigTable root_, table_;
};

// Writes lines of "key = value  # comment". Numbers are read back bit for bit.
class Writer {
 public:
  explicit Writer(const std::map<std::string, std::string>& comments) : comments_(comments) {}

  void table(const std::string& name) {
    table_ = name + ".";
    text += "\n[" + name + "]\n";
  }
  void number(const std::string& key, double value) { line(key, runtime::shortest_text(value)); }
  void optional(const std::string& key, double value) {
    if (value != 0.0) number(key, value);
  }
  void lens(sensors::Lens lens) {
    if (lens != sensors::Lens{}) line("lens", '"' + std::string(to_string(lens)) + '"');
  }
  void vector(const std::string& key, const Eigen::Vector3d& v) { line(key, v.data(), 3); }
  void rotation(const std::string& key, const RowMajor& m) { line(key, m.data(), 9); }
  void direction(const sensors::CameraModel&, const sensors::StereoRig&) {
    line("direction", '"' + std::string(to_distorted) + '"');
  }

  std::string text;

 private:
  void line(const std::string& key, const std::string& value) {
    text += key + " = " + value;
    if (const auto found = comments_.find(table_ + key); found != comments_.end())
      text += "  # " + found->second;
    text += '\n';
  }
  void line(const std::string& key, const double* values, int count) {
    std::string list = "[";
    for (int i = 0; i < count; ++i) {
      list += (i == 0 ? "" : ", ") + runtime::shortest_text(values[i]);
    }
    line(key, list + "]");
  }

  const std::map<std::string, std::string>& comments_;
  std::string table_;
};

sensors::StereoRig read_toml(const std::filesystem::path& file) {
  const runtime::ConfigDocument document = runtime::ConfigDocument::load(file);
  sensors::StereoRig rig;
  Reader reader(document.root());
  each_value(rig, reader);
  document.reject_unknown();
  if (const auto problem = problem_of(rig))
    throw std::runtime_error("calibration '" + file.string() + "': " + *problem);
  return rig;
}

}  // namespace

sensors::StereoRig read_stereo_rig(const std::filesystem::path& file) {
  if (file.extension() != ".txt") return read_toml(file);
  return sensors::parse_kitti_rig(read_text(file, input_limits::settings), file);
}

std::string to_toml(const sensors::StereoRig& rig,
                    const std::map<std::string, std::string>& comments) {
  Writer writer(comments);
  each_value(rig, writer);
  return writer.text;
}

}  // namespace maploop::vehicle
