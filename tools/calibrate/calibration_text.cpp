#include "tools/calibrate/calibration_output.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <array>
#include <numbers>

#include "runtime/vehicle/drivers/stereo_rig_file.h"

namespace maploop::calibrate {
namespace {

constexpr double degrees_per_radian = 180.0 / std::numbers::pi;

std::string board_text(const Board& board) {
  return fmt::format("{}x{} inner corners, squares of {:g} m", board.columns, board.rows,
                     board.square);
}

// Returns the right camera's rotation relative to the left one, as a rotation vector (rad).
Eigen::Vector3d turn_of(const sensors::StereoRig& rig) {
  const Eigen::AngleAxisd turn(rig.T_right_left.linear());
  return turn.angle() * turn.axis();
}

std::string matrix_text(const Eigen::Matrix3d& m) {
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += fmt::format("  {: .8e} {: .8e} {: .8e}\n", m(i, 0), m(i, 1), m(i, 2));
  return text;
}

std::string coefficients(const sensors::Distortion& d) {
  return fmt::format("k1 {:.6f}  k2 {:.6f}  k3 {:.6f}  p1 {:.6f}  p2 {:.6f}", d.k1, d.k2, d.k3,
                     d.p1, d.p2);
}

std::string views_text(const StereoResult& r) {
  std::string text = "view                           left px  right px\n";
  for (const ViewResult& view : r.views) {
    const auto [left, right] = rms_of(view.residuals);
    text += fmt::format("{:30} {:7.3f}  {:8.3f}\n", view.view.name, left, right);
  }
  for (const BadView& bad : r.bad)
    text += fmt::format("{:30} left out in round {}: {:.3f} px, limit {:.3f} px\n", bad.name,
                        bad.round, bad.rms, bad.limit);
  return text;
}

// Writes lines "KEY: 1.000000e+00 ...".
class KittiWriter {
 public:
  void line(const std::string& key, std::initializer_list<double> values) {
    text += key + ":";
    for (const double value : values) text += fmt::format(" {:.6e}", value);
    text += '\n';
  }
  void line(const std::string& key, const Eigen::Matrix3d& m) {
    line(key, {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)});
  }
  void camera(const std::string& number, const sensors::StereoRig& rig,
              const sensors::CameraModel& c, const Eigen::Isometry3d& T_camera_left,
              const Eigen::Matrix3d& R_rect, double baseline) {
    const sensors::Distortion& d = c.distortion;
    const StereoCalibration& r = rig.rectified;
    const Eigen::Vector3d t = T_camera_left.translation();
    line("S_" + number, {double(rig.width), double(rig.height)});
    line("K_" + number, {c.fx, 0.0, c.cx, 0.0, c.fy, c.cy, 0.0, 0.0, 1.0});
    line("D_" + number, {d.k1, d.k2, d.p1, d.p2, d.k3});
    line("R_" + number, Eigen::Matrix3d(T_camera_left.linear()));
    line("T_" + number, {t.x(), t.y(), t.z()});
    line("S_rect_" + number, {double(r.width), double(r.height)});
    line("R_rect_" + number, R_rect);
    line("P_rect_" + number,
         {r.fx, 0.0, r.cx, -r.fx * baseline, 0.0, r.fy, r.cy, 0.0, 0.0, 0.0, 1.0, 0.0});
  }

  std::string text;
};

}  // namespace

std::vector<Parameter> parameters_of(const StereoResult& r) {
  std::vector<Parameter> all;
  const auto add = [&](const std::string& name, const std::string& unit, double value,
                       double scale = 1.0) {
    const auto i = static_cast<Eigen::Index>(all.size());
    all.push_back({name, unit, value, scale * r.adjustment.sigma[i]});
  };
  for (const bool is_left : {true, false}) {
    sensors::CameraModel camera = is_left ? r.rig.left : r.rig.right;
    const auto numbers = numbers_of(camera);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      add(std::string(is_left ? "left." : "right.") + camera_parameter_names[i], i < 4 ? "px" : "",
          *numbers[i]);
  }
  const Eigen::Vector3d turn = turn_of(r.rig), t = r.rig.T_right_left.translation();
  for (const int i : {0, 1, 2})
    add(std::string("rotation_right_left.") + "xyz"[i], "deg", turn[i] * degrees_per_radian,
        degrees_per_radian);
  for (const int i : {0, 1, 2}) add(std::string("t_right_left.") + "xyz"[i], "m", t[i]);
  return all;
}

std::string to_text(const StereoResult& r, const std::vector<Unusable>& unusable) {
  std::string text = "board: " + board_text(r.board) + "\n\n" + views_text(r);
  for (const Unusable& u : unusable) text += u.name + ": not used: " + u.reason + '\n';
  text += fmt::format(
      "\n{} views, {:.3f} px root mean square, rectified rows {:.3f} px apart, corners in {:.0f} "
      "and {:.0f} % of the image's fields\n\n",
      r.views.size(), r.adjustment.rms, r.row_error, 100.0 * r.coverage[0].share(),
      100.0 * r.coverage[1].share());
  text += "parameter                        value        sigma\n";
  for (const Parameter& p : parameters_of(r))
    text += fmt::format("{:24} {:14.6f} {:12.6f} {}\n", p.name, p.value, p.sigma, p.unit);
  text += "(distortion: undistorted -> distorted, as OpenCV, ROS and Kalibr have it)\n\n";
  text += "distorted -> undistorted, fitted over the image:\n";
  for (const std::size_t side : {0U, 1U})
    text += fmt::format("  {:5} {} (to {:.3f} px)\n", side == 0 ? "left" : "right",
                        coefficients(r.reversed[side].distortion), r.reversed[side].largest_error);
  const StereoCalibration& rect = r.rig.rectified;
  text += fmt::format(
      "\nrectified: {} x {} px, f {:.4f} px, centre {:.3f} {:.3f} px, baseline {:.6f} m\n",
      rect.width, rect.height, rect.fx, rect.cx, rect.cy, rect.baseline);
  text += "essential matrix\n" + matrix_text(essential_matrix(r.rig));
  text += "fundamental matrix\n" + matrix_text(fundamental_matrix(r.rig));
  for (const std::string& warning : r.warnings) text += "warning: " + warning + '\n';
  return text;
}

std::string to_toml(const StereoResult& r) {
  std::map<std::string, std::string> comments;
  for (const Parameter& p : parameters_of(r)) {
    const std::string sigma = fmt::format("sigma {:.2g}", p.sigma);
    comments[p.name] = p.unit.empty() ? sigma : sigma + " " + p.unit;
  }
  const CommonVector& s = r.adjustment.sigma;
  comments["extrinsics.R_right_left"] =
      fmt::format("sigma {:.2g} {:.2g} {:.2g} deg about x y z", s[18] * degrees_per_radian,
                  s[19] * degrees_per_radian, s[20] * degrees_per_radian);
  comments["extrinsics.t_right_left"] =
      fmt::format("m, sigma {:.2g} {:.2g} {:.2g}", s[21], s[22], s[23]);
  comments["rectification.baseline"] = "m";
  return fmt::format(
             "# Stereo calibration by maploop calibrate: {} views, board of {},\n"
             "# {:.3f} px root mean square. Rotations row by row.\n",
             r.views.size(), board_text(r.board), r.adjustment.rms) +
         vehicle::to_toml(r.rig, comments);
}

std::string to_kitti(const StereoResult& r) {
  KittiWriter out;
  out.line("corner_dist", {r.board.square});
  out.camera("00", r.rig, r.rig.left, Eigen::Isometry3d::Identity(), r.rig.R_rect_left, 0.0);
  out.camera("01", r.rig, r.rig.right, r.rig.T_right_left, r.rig.R_rect_right,
             r.rig.rectified.baseline);
  return out.text;
}

}  // namespace maploop::calibrate
