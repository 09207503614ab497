// The combinations of ambiguities that the last epoch has fixed to integers. Whether the next epoch
// fixes the same ones tells right integers from wrong ones.
#pragma once

#include <vector>

#include "ppp/integers/ambiguity_differences.h"

namespace maploop::ppp {

class FixedCombinations {
 public:
  FixedCombinations();
  void clear();
  // Takes the integers of the last decorrelated ambiguities.
  void remember(const AmbiguityDifferences& differences, const Lambda& lambda,
                const Lambda::Vector& integers);
  // Returns how many combinations have the same integers given another epoch's, as far as these
  // determine them; -1 if one has another integer.
  int same(const AmbiguityDifferences& differences, const DifferenceValues& given) const;
  // Forgets the combinations with a satellite's ambiguities, which have begun anew.
  void forget(Satellite satellite);

  static constexpr std::size_t largest_archive =
      (Lambda::max_size + 2) * Lambda::max_size * sizeof(double) + 512;
  template <class Archive>
  void archive(Archive& ar) {
    ar(satellites_, shares_, integers_);
    if constexpr (Archive::loading) {
      if (shares_.size() != integers_.size() * satellites_.size() * ambiguities_of_one)
        ar.fail("the shares of ambiguities do not match their satellites");
    }
  }

 private:
  std::vector<Satellite> satellites_;
  // For each combination, the shares of each satellite's two ambiguities, which add up to 0 over a
  // system.
  std::vector<double> shares_;
  std::vector<double> integers_;
};

}  // namespace maploop::ppp
