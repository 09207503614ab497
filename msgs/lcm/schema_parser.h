// The .lcm language, one text at a time; names of other types are left to Schema to resolve.
#pragma once

#include <vector>

#include "msgs/lcm/schema.h"

namespace maploop::schema {

struct ParsedType {
  Type type;                      // Member::type and fingerprint still missing
  std::string source;             // of its text
  int line = 0;                   // of its declaration
  std::vector<int> member_lines;  // one a member
};

// Throws std::runtime_error "source:line: what is wrong".
std::vector<ParsedType> parse_types(const TypeText& text);

}  // namespace maploop::schema
