#include "ppp/filter/single_point.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::ppp {
namespace {

constexpr int columns = 3 + system_count;  // position, and the clock of each system
using Unknowns = Eigen::Matrix<double, columns, 1>;

constexpr int max_iterations = 12;
constexpr double settled_step = 1e-3;  // m

// Without a position near the earth's surface there is no local frame: the first iterations do
// without models. Distances are in m from the earth's centre.
constexpr double deepest_with_models = 6.2e6;
constexpr double anywhere_on_earth = 6378137.0;
constexpr double mean_radius = 6.37e6, deepest = -1e5, highest = 1e6;  // m; heights of a receiver

// The normal equations of the codes about a position.
struct NormalEquations {
  Eigen::Matrix<double, columns, columns> normal = Eigen::Matrix<double, columns, columns>::Zero();
  Unknowns right = Unknowns::Zero();
  std::array<bool, system_count> has_clock{};
  int first_clock = -1;  // the first system's that was measured
  int used = 0;
  // This is the sum of the squared residuals, in variances of the carriers' mean: larger residuals
  // than expected come from reflections, which removing the ionosphere does not amplify.
  double sum = 0.0;
  double worst = 0.0;  // residual, in standard deviations
  std::size_t worst_at = 0;
};

// The range by a satellite's code, without the ionosphere where there are two carriers.
struct RangeByCode {
  double beyond_predicted, sigma;  // m; sigma at the zenith
  double amplified = 1.0;          // sigma squared, relative to that of the carriers' mean

  RangeByCode(const Measurement& m, const PredictedRange& p, const PppParameters& parameters) {
    const auto beyond = [&](Combination c) { return m.code(c) - p.code(m, c); };
    const auto sigma_of = [&](Combination c) {
      return m.sigma(c, parameters.code_sigma, parameters.common_code_sigma);
    };
    const double mean = sigma_of(Combination::range);
    beyond_predicted = beyond(Combination::range);
    sigma = mean;
    if (!m.dual()) return;
    const double weight = m.ionosphere_free_weight();
    beyond_predicted += weight * beyond(Combination::ionosphere);
    sigma = std::hypot(mean, weight * sigma_of(Combination::ionosphere));
    amplified = sigma * sigma / (mean * mean);
  }
};

class CodePositioning {
 public:
  CodePositioning(const std::vector<Measurement>& measured, GpsTime t,
                  const PppParameters& parameters, RangeModel& model)
      : measured_(measured),
        t_(t),
        parameters_(parameters),
        model_(model),
        left_out_(measured.size(), false) {}

  SinglePoint solve(const Eigen::Vector3d& near) {
    SinglePoint result;
    position_ = near;
    const int max_rejections =
        static_cast<int>(parameters_.start_outlier_share * static_cast<double>(measured_.size()));
    for (int rejections = 0;;) {
      const NormalEquations last = settle(result.failure);
      if (!result.failure.empty()) return result;
      if (free_clock(last)) continue;
      if (last.worst > parameters_.start_outlier_sigmas && rejections < max_rejections) {
        left_out_[last.worst_at] = true;
        ++rejections;
        continue;
      }
      if (last.worst > parameters_.start_largest_residual) {
        result.failure = "codes disagree beyond the share of satellites that may be left out";
        return result;
      }
      result.position = position_;
      if (const int spare = last.used - unknowns(); spare > 0)
        result.residual_level = last.sum / spare;
      return result;
    }
  }

 private:
  // Iterates until the position settles, and returns the last equations.
  NormalEquations settle(std::string& failure) {
    NormalEquations equations;
    bool settled = false;
    for (int i = 0; i < max_iterations && !settled; ++i) {
      equations = linearize();
      if (equations.used < unknowns()) {
        failure = std::to_string(equations.used) +
                  " satellites with orbit, clock and code above the mask, and " +
                  std::to_string(unknowns()) + " are needed";
        return equations;
      }
      const Unknowns dx = equations.normal.ldlt().solve(equations.right);
      if (!dx.allFinite()) break;
      position_ += dx.head<3>();
      clocks_ += dx.tail<system_count>();
      settled = dx.head<3>().norm() < settled_step;
    }
    const double height = position_.norm() - mean_radius;
    if (!settled || height < deepest || height > highest)
      failure = "the position by code does not settle";
    return equations;
  }

  NormalEquations linearize() {
    const bool on_earth = position_.norm() > deepest_with_models;
    model_.begin(t_, on_earth ? position_ : Eigen::Vector3d(anywhere_on_earth, 0, 0));
    NormalEquations equations;
    for (std::size_t i = 0; i < measured_.size(); ++i) {
      if (left_out_[i]) continue;
      if (const auto predicted = predict(measured_[i], on_earth)) add(i, *predicted, equations);
    }
    add_clocks(equations);
    return equations;
  }

  int unknowns() const {
    return position_unknowns + static_cast<int>(std::count(free_.begin(), free_.end(), true));
  }

  // Estimates the clock of a system whose difference does not fit from its codes alone, if there is
  // redundancy without it. Returns whether there is such a system.
  bool free_clock(const NormalEquations& last) {
    if (last.used <= unknowns() + 1) return false;
    const double most = parameters_.start_outlier_sigmas * parameters_.clock_difference_sigma;
    for (std::size_t s = 0; s < free_.size(); ++s) {
      if (free_[s] || !last.has_clock[s]) continue;
      if (std::abs(clocks_[static_cast<Eigen::Index>(s)] - clocks_[last.first_clock]) <= most)
        continue;
      free_[s] = true;
      return true;
    }
    return false;
  }

  // The clock of each system is that of the first, known to `clock_difference_sigma`.
  void add_clocks(NormalEquations& equations) const {
    const double weight =
        1.0 / (parameters_.clock_difference_sigma * parameters_.clock_difference_sigma);
    int& first = equations.first_clock;
    for (int s = 0; s < system_count; ++s) {
      if (!equations.has_clock[static_cast<std::size_t>(s)]) {
        equations.normal(3 + s, 3 + s) = 1.0;
      } else if (first < 0) {
        first = s;
      } else if (!free_[static_cast<std::size_t>(s)]) {
        Unknowns h = Unknowns::Zero();
        h[3 + s] = 1.0;
        h[3 + first] = -1.0;
        const double y = clocks_[first] - clocks_[s];
        equations.normal += h * h.transpose() * weight;
        equations.right += h * (y * weight);
        equations.sum += y * y * weight;
      }
    }
  }

  std::optional<PredictedRange> predict(const Measurement& m, bool on_earth) const {
    double wind_up_cycles = 0.0;
    auto p = model_.predict(m, wind_up_cycles);
    if (!p) return {};
    if (on_earth) {
      if (p->elevation < radians(parameters_.elevation_mask)) return {};
      return p;
    }
    const Eigen::Vector3d d = p->satellite.position - position_;
    p->range = d.norm() - speed_of_light * p->satellite.clock;
    p->to_satellite = d.normalized();
    p->elevation = 1.0;  // rad, of any satellite: all count about equally
    return p;
  }

  void add(std::size_t i, const PredictedRange& p, NormalEquations& equations) const {
    const Measurement& m = measured_[i];
    const int system = static_cast<int>(m.satellite.system);
    const RangeByCode code(m, p, parameters_);
    const double noise = code.sigma / std::sin(p.elevation);
    const double ionosphere = m.dual() ? 0.0 : p.ionosphere.sigma;
    const double variance = noise * noise + p.satellite.sigma * p.satellite.sigma +
                            ionosphere * ionosphere + parameters_.start_model_variance;
    const double y = code.beyond_predicted - clocks_[system];
    Unknowns h = Unknowns::Zero();
    h.head<3>() = -p.to_satellite;
    h[3 + system] = 1.0;
    equations.normal += h * h.transpose() / variance;
    equations.right += h * (y / variance);
    equations.has_clock[static_cast<std::size_t>(system)] = true;
    ++equations.used;
    equations.sum += code.amplified * y * y / variance;
    const double normalized = std::abs(y) / std::sqrt(variance);
    if (normalized > equations.worst) {
      equations.worst = normalized;
      equations.worst_at = i;
    }
  }

  const std::vector<Measurement>& measured_;
  GpsTime t_;
  const PppParameters& parameters_;
  RangeModel& model_;
  std::vector<bool> left_out_;
  std::array<bool, system_count> free_{};  // systems whose clock may be far from the others'
  Eigen::Vector3d position_{0, 0, 0};      // m, earth-fixed
  Eigen::Matrix<double, system_count, 1> clocks_ = Eigen::Matrix<double, system_count, 1>::Zero();
};

}  // namespace

SinglePoint solve_single_point(const std::vector<Measurement>& measured, GpsTime t,
                               const Eigen::Vector3d& near, const PppParameters& parameters,
                               RangeModel& model) {
  return CodePositioning(measured, t, parameters, model).solve(near);
}

}  // namespace maploop::ppp
