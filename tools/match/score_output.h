// Link identification as text and JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/match/match_score.h"

namespace maploop::match {

// For a person: the share on the right way with coverage, of all labels and of certain ones.
std::string to_text(const MatchScore& score);

// A table of P(link) as it was said and the share that was right.
std::string to_text(const Reliability& reliability);

// The same for a program, with the reliability of P(link).
nlohmann::json to_json(const MatchScore& score);

}  // namespace maploop::match
