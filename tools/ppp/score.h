// Errors of positions against the truth, with the coverage beside every accuracy.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "msgs/protection_levels.h"
#include "ppp/filter/solution.h"
#include "tools/ppp/truth.h"

namespace maploop::gnss {

struct ErrorAt {
  ppp::GpsTime time{};
  Eigen::Vector3d enu{0, 0, 0};         // m
  Eigen::Vector3d sigma{0, 0, 0};       // m, formal
  double nees = 0.0;                    // of three dimensions
  bool fixed = false;                   // with integer ambiguities
  bool moves = false;                   // else there is no direction of travel
  Eigen::Vector3d travel{0, 0, 0};      // m, along and across the direction of travel, and up
  Eigen::Vector3d protection{0, 0, 0};  // m, levels of the same
};

struct Accuracy {
  std::size_t with_truth = 0, solved = 0;                                        // epochs
  double horizontal_rmse = 0, up_rmse = 0, horizontal_95 = 0, three_d_last = 0;  // m
  double across_rmse = 0;                   // m, across the direction of travel, while it moves
  Eigen::Vector3d mean_enu{0, 0, 0};        // m
  double horizontal_rmse_without_mean = 0;  // m: one constant offset removed
  double nees = 0;                          // mean; 3 where the covariance is right
  std::size_t fixed = 0;                    // epochs with integer ambiguities
  std::size_t wrongly_fixed = 0;            // of them, those whose 3-D error is above 0.1 m

  double coverage() const {
    return with_truth > 0 ? static_cast<double>(solved) / static_cast<double>(with_truth) : 0.0;
  }
};

class Score {
 public:
  // Protection levels are for this integrity risk.
  Score(const Truth& truth, double integrity_risk)
      : truth_(truth), factor_(integrity_factor(integrity_risk)) {}

  void add(const ppp::PppSolution& solution);

  // Of the epochs from `from` on, where it is given.
  Accuracy accuracy(std::optional<ppp::GpsTime> from = {}) const;
  // Seconds until the 3-D error stays below a limit to the end; nothing: never.
  std::optional<double> time_to_stay_below(double limit) const;
  // Errors beyond their protection level, of the three of each epoch.
  std::size_t misleading() const;
  const std::vector<ErrorAt>& errors() const { return errors_; }

 private:
  const Truth& truth_;
  double factor_;
  std::vector<ErrorAt> errors_;
  std::vector<ppp::GpsTime> with_truth_;
};

std::string to_text(const Accuracy& accuracy);

}  // namespace maploop::gnss
