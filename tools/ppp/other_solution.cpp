#include "tools/ppp/other_solution.h"

#include "tools/evaluate/rtklib_positions.h"

namespace maploop::gnss {

using namespace maploop::ppp;

void OtherSolution::add(const PppSolution& solution) {
  if (solution.has_position()) positions[solution.time] = solution.position;
}

std::optional<Eigen::Vector3d> OtherSolution::at(GpsTime t) const {
  constexpr Duration same = std::chrono::milliseconds(10);
  const auto found = positions.lower_bound(t - same);
  if (found == positions.end() || found->first > t + same) return {};
  return found->second;
}

OtherSolution read_solution(const std::filesystem::path& file) {
  OtherSolution solution{file.filename().string()};
  for (const evaluation::RtklibPosition& p : evaluation::read_rtklib_positions(file))
    solution.positions[p.time] = p.place;
  return solution;
}

}  // namespace maploop::gnss
