// Formats the scores of link identification as text and JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/match/match_score.h"

namespace maploop::match {

// Returns the share of fixes on the right way and the coverage, of all labels and of certain ones,
// as text.
std::string to_text(const MatchScore& score);

// Returns a table of the mean P(link) and the share that was right.
std::string to_text(const Reliability& reliability);

// Returns the same scores as JSON, including the reliability of P(link).
nlohmann::json to_json(const MatchScore& score);

}  // namespace maploop::match
