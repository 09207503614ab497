// The ambiguities of an epoch that can be integers, as differences between satellites of a system:
// what these have in common, such as the receiver's biases, is no integer.
#pragma once

#include <array>
#include <vector>

#include "ppp/filter/filter_state.h"
#include "ppp/filter/linear_row.h"
#include "ppp/integers/lambda.h"

namespace maploop::ppp {

// The ambiguities of a satellite's first carrier and of its wide lane (the first less the second
// carrier's), cycles.
using Integers = std::array<double, 2>;
inline constexpr std::size_t ambiguities_of_one = std::tuple_size_v<Integers>;

// An ambiguity is an integer if it is known to this, cycles, and no farther from one.
inline constexpr double integer_sigma = 0.05, integer_distance = 0.15;

// A satellite whose ambiguities can be integers.
struct IntegerCandidate {
  Satellite satellite;
  std::size_t tracked = 0;           // index into the epoch's tracked satellites
  std::array<int, 2> indices{};      // of its ambiguities of range and ionosphere in the state
  std::array<Integers, 2> cycles{};  // for each metre of these
  std::size_t reference = 0;         // the candidate of its system that it is differenced against
  Eigen::Index difference = -1;      // of its first ambiguity; -1: it is the reference
  bool own = false;                  // both ambiguities are integers in this solution

  bool differenced() const { return difference >= 0; }
};

// The differences as they are in a state of the filter.
struct DifferenceValues {
  Lambda::Vector values;      // cycles
  Lambda::Matrix covariance;  // cycles^2
};

class AmbiguityDifferences {
 public:
  static constexpr std::size_t most_candidates = Lambda::max_size / ambiguities_of_one;

  AmbiguityDifferences();
  void clear();
  // Adds a satellite, if there is room.
  void add(const IntegerCandidate& candidate);
  // Makes the differences of all satellites that were added. The most precise ambiguity of each
  // system is the one that the others are differenced against.
  void make(const FilterState& state);

  const std::vector<IntegerCandidate>& candidates() const { return candidates_; }  // by satellite
  // Returns the indices of the candidates that are no reference.
  const std::vector<std::size_t>& differenced() const { return differenced_; }
  // Returns two rows of each of these, in cycles.
  const std::vector<LinearRow>& rows() const { return rows_; }
  void evaluate(const FilterState& state, DifferenceValues& result) const;

  // Marks the satellites whose own ambiguities are integers, given these values: the largest group
  // of a system in which all differences from one of them are.
  void mark_integers(const DifferenceValues& given);

 private:
  void choose_references(const FilterState& state);

  std::vector<IntegerCandidate> candidates_;
  std::vector<std::size_t> differenced_;
  std::vector<LinearRow> rows_;
};

}  // namespace maploop::ppp
