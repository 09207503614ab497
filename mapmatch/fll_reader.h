// Rule bases are read here from FLL, the language of the fuzzylite library and its program.
//
// The reader accepts the part of FLL that these systems need: input variables with Sigmoid, Ramp,
// Triangle and Trapezoid terms; one output variable with Constant or Linear terms and the
// defuzzifier WeightedAverage, or with shapes, the aggregation Maximum and the defuzzifier Centroid
// (with the implication Minimum); and one block of rules "if A is T and B is T then OUT is T",
// perhaps "with WEIGHT". It refuses anything else, so that no rule is silently ignored.
#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string_view>

#include "mapmatch/fuzzy_system.h"

namespace maploop::mapmatch {

// Its message names the file, the line and the error.
class FllError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Parses a rule base; error messages use `name`. The input variables must be those in `inputs`, in
// any order; the system takes its values in the order of `inputs`. Throws FllError.
FuzzySystem parse_fll(std::string_view text, std::string_view name,
                      std::span<const std::string_view> inputs);

// Also throws FllError if the file cannot be read.
FuzzySystem read_fll(const std::filesystem::path& file, std::span<const std::string_view> inputs);

}  // namespace maploop::mapmatch
