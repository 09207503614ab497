// The filter's state consists of fixed entries followed by one float ambiguity per satellite. It is
// updated one scalar at a time, which suits rows with few entries.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "ppp/satellite.h"

namespace maploop::ppp {

class FilterState {
 public:
  static constexpr int position = 0, velocity = 3;  // earth-fixed, m and m/s
  static constexpr int clock = 6, clock_drift = 7;  // m, m/s
  static constexpr int zenith_wet = 8;              // m, in addition to the model's value
  static constexpr int gradient_north = 9, gradient_east = 10;  // m
  // Only a map observes these: the lasting error of the position (from orbits, clocks and
  // ionosphere), east and north; the map's datum relative to that of the orbits, east and north;
  // and the vehicle's offset from the map's line in standard deviations (MapFeedback::lane_sigma).
  static constexpr int lasting_error = 11;  // m
  static constexpr int map_datum = 13;      // m
  static constexpr int lane_offset = 15;
  static constexpr int system_offset = 16;  // m, of each system's clock against the reference's
  static constexpr int fixed = system_offset + system_count;
  static constexpr int max_ambiguities = 64;
  static constexpr int capacity = fixed + max_ambiguities;

  FilterState() { clear(); }
  void clear();

  int size() const { return fixed + static_cast<int>(ambiguities_.size()); }
  auto x() { return x_.head(size()); }
  auto x() const { return x_.head(size()); }
  auto P() { return P_.topLeftCorner(size(), size()); }
  auto P() const { return P_.topLeftCorner(size(), size()); }

  // Replaces a value, its variance (`sigma` squared) and its correlations, which become zero.
  void set(int index, double value, double sigma);
  // Returns the index of the satellite's ambiguity; -1 if it has none.
  int ambiguity(Satellite satellite) const;
  // Returns the index of the new ambiguity; -1 if there is no room.
  int add_ambiguity(Satellite satellite, double value, double sigma);
  void remove_ambiguity(Satellite satellite);
  const std::vector<Satellite>& ambiguities() const { return ambiguities_; }

  // Applies one measurement, y = h dx + noise, with the entries of h at `indices`. `y` refers to
  // the x before all updates of this epoch; `dx` accumulates the updates, which the caller adds to
  // x.
  void update(std::span<const int> indices, std::span<const double> h, double y, double variance,
              Eigen::VectorXd& dx);

  template <class Archive>
  void archive(Archive& ar) {
    ar(ambiguities_);
    if constexpr (Archive::loading) {
      if (ambiguities_.size() > max_ambiguities)
        ar.fail("more ambiguities than the state has room for");
    }
    const auto n = static_cast<std::size_t>(size());
    std::vector<double> values(n + n * n);
    if constexpr (!Archive::loading) {
      Eigen::Map<Eigen::VectorXd>(values.data(), size()) = x();
      Eigen::Map<Eigen::MatrixXd>(values.data() + n, size(), size()) = P();
    }
    ar(values);
    if constexpr (Archive::loading) {
      if (values.size() != n + n * n)
        ar.fail("the size of the state does not match its ambiguities");
      x() = Eigen::Map<Eigen::VectorXd>(values.data(), size());
      P() = Eigen::Map<Eigen::MatrixXd>(values.data() + n, size(), size());
    }
  }

 private:
  std::vector<Satellite> ambiguities_;
  Eigen::Matrix<double, capacity, 1> x_;
  Eigen::Matrix<double, capacity, capacity> P_;
  Eigen::Matrix<double, capacity, 1> column_;
};

}  // namespace maploop::ppp
