// This file parses the .lcm language, one text at a time; Schema resolves the names of other types.
#pragma once

#include <vector>

#include "msgs/lcm/schema.h"

namespace maploop::schema {

struct ParsedType {
  Type type;                      // without Member::type and fingerprint
  std::string source;             // of its text
  int line = 0;                   // of its declaration
  std::vector<int> member_lines;  // one for each member
};

// Throws std::runtime_error with the text "source:line: what is wrong".
std::vector<ParsedType> parse_types(const TypeText& text);

}  // namespace maploop::schema
