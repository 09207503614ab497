// The installed rule bases are read once.
#pragma once

#include "mapmatch/rule_bases.h"

namespace maploop::testing {

inline const mapmatch::RuleBases& rules() {
  static const mapmatch::RuleBases bases = mapmatch::read_rule_bases(mapmatch::default_rules());
  return bases;
}

}  // namespace maploop::testing
