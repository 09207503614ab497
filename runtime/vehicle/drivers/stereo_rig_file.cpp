#include "runtime/vehicle/drivers/stereo_rig_file.h"

#include <Eigen/Dense>
#include <stdexcept>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "runtime/core/config.h"
#include "runtime/core/number_text.h"
#include "sensors/replay/kitti_calibration.h"

namespace maploop::vehicle {
namespace {

using runtime::ConfigTable;

constexpr const char* to_distorted = "undistorted_to_distorted";
constexpr const char* to_undistorted = "distorted_to_undistorted";

void read(const ConfigTable& table, const char* key, auto&& value) {
  if (!table.has(key)) table.fail(key, "is missing; a calibration needs every number");
  table.read(key, value);
}

Eigen::Matrix3d read_rotation(const ConfigTable& table, const char* key) {
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> printed;
  read(table, key, std::span<double>(printed.data(), 9));
  const Eigen::Matrix3d r = printed;
  if (!((r * r.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3) || r.determinant() < 0.0)
    table.fail(key, "is not a rotation matrix");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Eigen::Isometry3d read_pose(const ConfigTable& table, const char* rotation,
                            const char* translation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = read_rotation(table, rotation);
  read(table, translation, std::span<double>(pose.translation().data(), 3));
  return pose;
}

sensors::CameraModel read_camera(const ConfigTable& table, const sensors::StereoRig& rig) {
  sensors::CameraModel camera;
  read(table, "fx", camera.fx);
  read(table, "fy", camera.fy);
  read(table, "cx", camera.cx);
  read(table, "cy", camera.cy);
  sensors::Distortion& d = camera.distortion;
  read(table, "k1", d.k1);
  read(table, "k2", d.k2);
  read(table, "p1", d.p1);
  read(table, "p2", d.p2);
  read(table, "k3", d.k3);
  std::string direction = to_distorted;
  table.read_one_of("direction", direction, {to_distorted, to_undistorted});
  if (direction == to_undistorted) {
    if (!(camera.fx > 0.0 && camera.fy > 0.0)) table.fail("fx", "must be above 0");
    const auto converted = sensors::from_reversed(camera, rig.width, rig.height);
    constexpr double most = 0.5;  // px
    if (!(converted.largest_error < most))
      table.fail("direction",
                 "cannot be approximated by undistorted_to_distorted coefficients better than " +
                     std::to_string(converted.largest_error) + " px");
    d = converted.distortion;
  }
  return camera;
}

sensors::StereoRig read_toml(const std::filesystem::path& file) {
  const runtime::ConfigDocument document = runtime::ConfigDocument::load(file);
  const ConfigTable root = document.root();
  sensors::StereoRig rig;
  read(root, "width", rig.width);
  read(root, "height", rig.height);
  rig.left = read_camera(root.table("left"), rig);
  rig.right = read_camera(root.table("right"), rig);
  rig.T_right_left = read_pose(root.table("extrinsics"), "R_right_left", "t_right_left");

  const ConfigTable rectification = root.table("rectification");
  rig.R_rect_left = read_rotation(rectification, "R_rect_left");
  rig.R_rect_right = read_rotation(rectification, "R_rect_right");
  StereoCalibration& r = rig.rectified;
  read(rectification, "width", r.width);
  read(rectification, "height", r.height);
  read(rectification, "fx", r.fx);
  read(rectification, "fy", r.fy);
  read(rectification, "cx", r.cx);
  read(rectification, "cy", r.cy);
  read(rectification, "baseline", r.baseline);
  if (root.has("mounting"))
    rig.T_body_left = read_pose(root.table("mounting"), "R_body_left", "p_body_left");
  document.reject_unknown();
  if (const auto problem = problem_of(rig))
    throw std::runtime_error("calibration '" + file.string() + "': " + *problem);
  return rig;
}

// Writes the numbers so that they are read back bit for bit.
std::string numbers(const double* values, int count) {
  std::string text = "[";
  for (int i = 0; i < count; ++i) text += (i == 0 ? "" : ", ") + runtime::shortest_text(values[i]);
  return text + "]";
}

// A Writer writes lines of "key = value  # comment".
class Writer {
 public:
  explicit Writer(const std::map<std::string, std::string>& comments) : comments_(comments) {}

  void table(const std::string& name) {
    table_ = name + ".";
    text += "\n[" + name + "]\n";
  }
  void line(const std::string& key, const std::string& value) {
    text += key + " = " + value;
    if (const auto found = comments_.find(table_ + key); found != comments_.end())
      text += "  # " + found->second;
    text += '\n';
  }
  void line(const std::string& key, double value) { line(key, runtime::shortest_text(value)); }
  void line(const std::string& key, const Eigen::Vector3d& v) { line(key, numbers(v.data(), 3)); }
  void line(const std::string& key, const Eigen::Matrix3d& m) {
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = m;
    line(key, numbers(rows.data(), 9));
  }

  std::string text;

 private:
  const std::map<std::string, std::string>& comments_;
  std::string table_;
};

void write(Writer& out, const std::string& name, const sensors::CameraModel& camera) {
  out.table(name);
  out.line("fx", camera.fx);
  out.line("fy", camera.fy);
  out.line("cx", camera.cx);
  out.line("cy", camera.cy);
  out.line("k1", camera.distortion.k1);
  out.line("k2", camera.distortion.k2);
  out.line("p1", camera.distortion.p1);
  out.line("p2", camera.distortion.p2);
  out.line("k3", camera.distortion.k3);
  out.line("direction", std::string("\"") + to_distorted + '"');
}

}  // namespace

sensors::StereoRig read_stereo_rig(const std::filesystem::path& file) {
  if (file.extension() != ".txt") return read_toml(file);
  return sensors::parse_kitti_rig(read_text(file, input_limits::settings), file);
}

std::string to_toml(const sensors::StereoRig& rig,
                    const std::map<std::string, std::string>& comments) {
  Writer out(comments);
  out.line("width", rig.width);
  out.line("height", rig.height);
  write(out, "left", rig.left);
  write(out, "right", rig.right);
  out.table("extrinsics");
  out.line("R_right_left", Eigen::Matrix3d(rig.T_right_left.linear()));
  out.line("t_right_left", Eigen::Vector3d(rig.T_right_left.translation()));
  out.table("rectification");
  out.line("R_rect_left", rig.R_rect_left);
  out.line("R_rect_right", rig.R_rect_right);
  const StereoCalibration& r = rig.rectified;
  out.line("width", r.width);
  out.line("height", r.height);
  out.line("fx", r.fx);
  out.line("fy", r.fy);
  out.line("cx", r.cx);
  out.line("cy", r.cy);
  out.line("baseline", r.baseline);
  if (rig.T_body_left) {
    out.table("mounting");
    out.line("R_body_left", Eigen::Matrix3d(rig.T_body_left->linear()));
    out.line("p_body_left", Eigen::Vector3d(rig.T_body_left->translation()));
  }
  return out.text;
}

}  // namespace maploop::vehicle
