// maploop calibrate: two cameras from images of a chessboard; with extrinsics, the sensors' places.

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/calibrate/calibration.h"
#include "tools/calibrate/calibration_output.h"
#include "tools/calibrate/views.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/command/progress.h"
#include "tools/evaluate/text_file.h"

namespace maploop::tools {
namespace {

struct CalibrateOptions {
  std::vector<std::string> images;
  std::string board;
  double square = 0.0;  // m
  std::filesystem::path toml = "calibration.toml", kitti, json, html;
};

std::string valid_board(const std::string& text) {
  try {
    calibrate::parse_board(text, 1.0);
    return {};
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

nlohmann::json rows_of(const Eigen::Matrix3d& m) {
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({m(i, 0), m(i, 1), m(i, 2)});
  return rows;
}

nlohmann::json result_json(const calibrate::StereoResult& r,
                           const std::vector<calibrate::Unusable>& unusable) {
  nlohmann::json parameters, views = nlohmann::json::array(), bad = views, refused = views;
  for (const calibrate::Parameter& p : parameters_of(r))
    parameters[p.name] = {{"value", p.value}, {"sigma", p.sigma}, {"unit", p.unit}};
  for (const calibrate::ViewResult& view : r.views) {
    const auto [left, right] = calibrate::rms_of(view.residuals);
    views.push_back({{"name", view.view.name}, {"left_px", left}, {"right_px", right}});
  }
  for (const calibrate::BadView& b : r.bad)
    bad.push_back({{"name", b.name}, {"px", b.rms}, {"limit_px", b.limit}, {"round", b.round}});
  for (const calibrate::Unusable& u : unusable)
    refused.push_back({{"name", u.name}, {"reason", u.reason}});
  nlohmann::json reversed;
  for (const std::size_t side : {0U, 1U}) {
    const sensors::Distortion& d = r.reversed[side].distortion;
    reversed[side == 0 ? "left" : "right"] = {
        {"k1", d.k1}, {"k2", d.k2}, {"k3", d.k3},
        {"p1", d.p1}, {"p2", d.p2}, {"largest_error_px", r.reversed[side].largest_error}};
  }
  const StereoCalibration& rect = r.rig.rectified;
  return {{"rms_px", r.adjustment.rms},
          {"row_error_px", r.row_error},
          {"coverage", {r.coverage[0].share(), r.coverage[1].share()}},
          {"parameters", parameters},
          {"distorted_to_undistorted", reversed},
          {"essential_matrix", rows_of(essential_matrix(r.rig))},
          {"fundamental_matrix", rows_of(fundamental_matrix(r.rig))},
          {"rectified",
           {{"width", rect.width},
            {"height", rect.height},
            {"f_px", rect.fx},
            {"cx_px", rect.cx},
            {"cy_px", rect.cy},
            {"baseline_m", rect.baseline}}},
          {"views", views},
          {"left_out", bad},
          {"not_used", refused},
          {"warnings", r.warnings}};
}

calibrate::FoundViews find_views(const calibrate::Board& board,
                                 const calibrate::ImagePairs& pairs) {
  Progress progress("pairs searched for the board");
  auto found = calibrate::find_views(board, pairs.pairs, [&](std::size_t done) {
    progress.at(static_cast<double>(done), static_cast<double>(pairs.pairs.size()));
  });
  found.unusable.insert(found.unusable.begin(), pairs.unpaired.begin(), pairs.unpaired.end());
  return found;
}

int calibrate_cameras(const CalibrateOptions& options) {
  const calibrate::Board board = calibrate::parse_board(options.board, options.square);
  const auto found = find_views(board, calibrate::list_pairs(options.images));
  calibrate::StereoResult result;
  try {
    if (found.views.empty())
      throw std::runtime_error("the board is found in no pair: " + found.hint);
    result = calibrate::calibrate(board, found.views, found.width, found.height);
  } catch (const std::runtime_error&) {
    for (const calibrate::Unusable& u : found.unusable)
      std::cerr << u.name << ": not used: " << u.reason << '\n';
    throw;
  }
  std::cout << to_text(result, found.unusable);
  evaluation::write_text(options.toml, to_toml(result));
  std::cout << "\nwritten: " << options.toml.string() << '\n';
  if (!options.kitti.empty()) evaluation::write_text(options.kitti, to_kitti(result));
  if (!options.json.empty()) write_json_file(options.json, result_json(result, found.unusable));
  if (!options.html.empty())
    evaluation::write_text(options.html, to_page(result, found.pairs, found.unusable));
  return 0;
}

}  // namespace

void add_calibrate(CLI::App& app, Command& command) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* sub = app.add_subcommand(
      "calibrate",
      "Calibrate a pair of cameras from their images of a chessboard, or where the sensors of a "
      "recorded drive are");
  auto* images = sub->add_option(
      "IMAGES", options->images,
      "A folder with folders left and right (or cam0 and cam1, image_00 and image_01) or "
      "with files left* and right*; or two patterns in quotes, 'left*.png' "
      "'right*.png'. The same name, or the same part in place of *, makes a pair");
  auto* board = sub->add_option("--board", options->board,
                                "Inner corners of the board, COLUMNSxROWS: 9x6 has 10 x 7 squares")
                    ->check(valid_board, "COLUMNSxROWS");
  auto* square = sub->add_option("--square", options->square, "Side of a square in metres")
                     ->check(number_in(0.001, 1.0));
  add_calibrate_extrinsics(*sub, command);
  sub->add_option(
         "--toml", options->toml,
         "Write the calibration to this file, which [vehicle.camera] calibration of --config names")
      ->capture_default_str()
      ->check(writable_file());
  sub->add_option("--kitti", options->kitti, "The same as KITTI's calib_cam_to_cam.txt")
      ->check(writable_file());
  sub->add_option("--json", options->json, "Write all figures to this file as JSON")
      ->check(writable_file());
  sub->add_option("--html", options->html, "Write a page with pictures to this file")
      ->check(writable_file());
  sub->callback([=, &command] {
    if (!sub->get_subcommands().empty()) return;
    for (const CLI::Option* needed : {images, board, square})
      if (needed->empty()) throw CLI::RequiredError(needed->get_name());
    command = [options] { return calibrate_cameras(*options); };
  });
}

}  // namespace maploop::tools
