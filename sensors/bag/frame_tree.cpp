#include "sensors/bag/frame_tree.h"

#include <deque>

namespace maploop::sensors {
namespace {

std::string_view plain(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  return name;
}

}  // namespace

void FrameTree::add(std::string_view parent, std::string_view child,
                    const Eigen::Isometry3d& T_parent_child) {
  const std::string a(plain(parent)), b(plain(child));
  if (a == b) return;
  if (frames_[a].try_emplace(b, T_parent_child).second) frames_[b][a] = T_parent_child.inverse();
}

bool FrameTree::contains(std::string_view frame) const {
  return frames_.contains(plain(frame));
}

std::optional<Eigen::Isometry3d> FrameTree::find(std::string_view a, std::string_view b) const {
  a = plain(a);
  b = plain(b);
  if (a == b) return Eigen::Isometry3d::Identity();
  std::map<std::string_view, Eigen::Isometry3d> reached{{a, Eigen::Isometry3d::Identity()}};
  std::deque<std::string_view> next{a};
  for (; !next.empty(); next.pop_front()) {
    const auto frame = frames_.find(next.front());
    if (frame == frames_.end()) continue;
    const Eigen::Isometry3d T_a_frame = reached.at(next.front());
    for (const auto& [name, T_frame_name] : frame->second) {
      if (!reached.try_emplace(name, T_a_frame * T_frame_name).second) continue;
      if (name == b) return T_a_frame * T_frame_name;
      next.push_back(name);
    }
  }
  return std::nullopt;
}

}  // namespace maploop::sensors
