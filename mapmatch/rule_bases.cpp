#include "mapmatch/rule_bases.h"

#include <cstdlib>
#include <system_error>

#include "mapmatch/fll_reader.h"

namespace maploop::mapmatch {

RuleBases read_rule_bases(const std::filesystem::path& folder) {
  return {read_fll(folder / "initial_matching.fll", initial_inputs),
          read_fll(folder / "along_link.fll", along_inputs),
          read_fll(folder / "along_link_visual.fll", visual_along_inputs),
          read_fll(folder / "junction.fll", junction_inputs)};
}

std::filesystem::path default_rules() {
  if (const char* folder = std::getenv("MAPLOOP_RULES")) return folder;
  std::error_code unreadable;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", unreadable);
  return program.parent_path().parent_path() / "share/maploop/rules";
}

}  // namespace maploop::mapmatch
