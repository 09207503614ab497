#include "mapmatch/rule_bases.h"

#include <cstdlib>

#include "mapmatch/fll_reader.h"
#include "msgs/shared_folder.h"

namespace maploop::mapmatch {

RuleBases read_rule_bases(const std::filesystem::path& folder) {
  return {read_fll(folder / "initial_matching.fll", initial_inputs),
          read_fll(folder / "along_link.fll", along_inputs),
          read_fll(folder / "along_link_visual.fll", visual_along_inputs),
          read_fll(folder / "junction.fll", junction_inputs)};
}

std::filesystem::path default_rules() {
  if (const char* folder = std::getenv("MAPLOOP_RULES")) return folder;
  return shared_folder() / "rules";
}

}  // namespace maploop::mapmatch
