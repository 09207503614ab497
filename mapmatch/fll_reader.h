// Reading rule bases in FLL, the language of the fuzzylite library and its program.
//
// Taken is the part that a zero-order Takagi-Sugeno-Kang system needs: input variables with
// Sigmoid, Ramp, Triangle and Trapezoid terms, one output variable with Constant terms, one block
// of rules "if A is T and B is T then OUT is T". Whatever else a file says is refused, so that no
// rule is ever passed over.
#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string_view>

#include "mapmatch/fuzzy_system.h"

namespace maploop::mapmatch {

// Says file, line, and what is wrong.
class FllError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// `name` is for messages. The input variables must be those named by `inputs`, in any order; the
// system takes its values in the order of `inputs`. Throws FllError.
FuzzySystem parse_fll(std::string_view text, std::string_view name,
                      std::span<const std::string_view> inputs);

// Throws FllError where the file cannot be read, too.
FuzzySystem read_fll(const std::filesystem::path& file, std::span<const std::string_view> inputs);

}  // namespace maploop::mapmatch
