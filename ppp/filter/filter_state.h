// The filter's state consists of fixed entries followed by those of each satellite. It is updated
// one scalar at a time, which suits rows with few entries.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppp/satellite.h"

namespace maploop::ppp {

// The entries that a satellite can have, m.
enum class Part : std::uint8_t {
  ionosphere,            // its slant delay on GPS L1 beyond the model's and the zenith entry's
  range_error,           // of orbit and clock
  ambiguity,             // of the range that the phases measure
  ionosphere_ambiguity,  // of the ionosphere that two phases measure
};

struct SatelliteEntry {
  Satellite satellite;
  Part part = Part::ionosphere;
  bool operator==(const SatelliteEntry&) const = default;
};

template <class Archive>
void archive(Archive& ar, SatelliteEntry& e) {
  ar(e.satellite, e.part);
  if constexpr (Archive::loading) {
    if (e.part > Part::ionosphere_ambiguity) ar.fail("not an entry of a satellite");
  }
}

class FilterState {
 public:
  static constexpr int position = 0, velocity = 3;  // earth-fixed, m and m/s
  static constexpr int clock = 6, clock_drift = 7;  // m, m/s
  static constexpr int zenith_wet = 8;              // m, in addition to the model's value
  static constexpr int gradient_north = 9, gradient_east = 10;  // m
  // The delay at the zenith on GPS L1 in addition to the model's, m, and how it grows to the north
  // and to the east, m for each 1000 km.
  static constexpr int zenith_ionosphere = 11, ionosphere_north = 12, ionosphere_east = 13;
  // Only a map observes these: the map's datum relative to that of the orbits, east and north; and
  // the vehicle's offset from the map's line in standard deviations (MapFeedback::lane_sigma).
  static constexpr int map_datum = 14;  // m
  static constexpr int lane_offset = 16;
  // Only a carried motion observes these: its direction is too far to the left, and it is too long.
  static constexpr int carried_turn = 17;   // rad
  static constexpr int carried_scale = 18;  // 1
  // Only a model of the ground's height observes these: what it is too low by everywhere, and here.
  static constexpr int ground_datum = 19, ground_error = 20;  // m
  static constexpr int system_offset = 21;  // m, of each system's clock against the reference's
  // By half of this the receiver delays each system's second code more than the first, m.
  static constexpr int code_difference = system_offset + system_count;
  static constexpr int fixed = code_difference + system_count;
  static constexpr int max_entries = 240;
  static constexpr int capacity = fixed + max_entries;

  FilterState() : x_(capacity), P_(capacity, capacity), column_(capacity) { clear(); }
  FilterState(const FilterState& other) : FilterState() { *this = other; }
  // Copies what is in use, without allocating.
  FilterState& operator=(const FilterState& other);
  void clear();

  int size() const { return fixed + static_cast<int>(entries_.size()); }
  auto x() { return x_.head(size()); }
  auto x() const { return x_.head(size()); }
  auto P() { return P_.topLeftCorner(size(), size()); }
  auto P() const { return P_.topLeftCorner(size(), size()); }

  // Replaces a value, its variance (`sigma` squared) and its correlations, which become zero.
  void set(int index, double value, double sigma);
  // Lets a first-order Gauss-Markov error of this variance decay: the share `keep` of it remains.
  void forget(int index, double keep, double variance);
  // Returns the index of a satellite's entry; -1 if it has none.
  int find(Satellite satellite, Part part) const;
  // Returns the index of the new entry; -1 if there is no room.
  int add(Satellite satellite, Part part, double value, double sigma);
  void remove(Satellite satellite, Part part);
  void remove_ambiguities(Satellite satellite);
  const std::vector<SatelliteEntry>& entries() const { return entries_; }

  // Applies one measurement, y = h dx + noise, with the entries of h at `indices`. `y` refers to
  // the x before all updates of this epoch; `dx` accumulates the updates, which the caller adds to
  // x.
  void update(std::span<const int> indices, std::span<const double> h, double y, double variance,
              Eigen::VectorXd& dx);

  template <class Archive>
  void archive(Archive& ar) {
    ar(entries_);
    if constexpr (Archive::loading) {
      if (entries_.size() > max_entries) ar.fail("more entries than the state has room for");
    }
    const auto n = static_cast<std::size_t>(size());
    std::vector<double> values(n + n * n);
    if constexpr (!Archive::loading) {
      Eigen::Map<Eigen::VectorXd>(values.data(), size()) = x();
      Eigen::Map<Eigen::MatrixXd>(values.data() + n, size(), size()) = P();
    }
    ar(values);
    if constexpr (Archive::loading) {
      if (values.size() != n + n * n) ar.fail("the size of the state does not match its entries");
      x() = Eigen::Map<Eigen::VectorXd>(values.data(), size());
      P() = Eigen::Map<Eigen::MatrixXd>(values.data() + n, size(), size());
    }
  }

 private:
  std::vector<SatelliteEntry> entries_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd P_;
  Eigen::VectorXd column_;
};

}  // namespace maploop::ppp
