#include "tools/match/labels.h"

#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tools/evaluate/text_file.h"

namespace maploop::match {

std::map<std::size_t, Label> read_labels(const std::filesystem::path& file) {
  std::istringstream lines(evaluation::read_text(file));
  std::map<std::size_t, Label> labels;
  std::string line;
  int number = 1;
  if (!std::getline(lines, line) || !line.starts_with("frame,way_id,node_a,node_b,conf"))
    throw std::runtime_error(file.string() +
                             ":1: labels begin with frame,way_id,node_a,node_b,conf");
  while (std::getline(lines, line)) {
    ++number;
    if (line.empty()) continue;
    unsigned long frame = 0;
    long long way = 0, a = 0, b = 0;
    int certain = 0;
    if (std::sscanf(line.c_str(), "%lu,%lld,%lld,%lld,%d", &frame, &way, &a, &b, &certain) != 5)
      throw std::runtime_error(file.string() + ":" + std::to_string(number) +
                               ": not frame,way_id,node_a,node_b,conf");
    labels[frame] = {way, a, b, certain == 1, {}};
  }
  return labels;
}

SegmentLinks::SegmentLinks(const mapmatch::RoadNetwork& network) {
  for (std::uint32_t link = 0; link < network.size(); ++link) {
    const std::uint32_t first = network.link(link).first_vertex;
    for (std::uint32_t v = first; v + 1 < first + network.link(link).vertex_count; ++v)
      for (const bool forward : {true, false})
        links_[network.nodes({link, forward}, v)] = {link, forward};
  }
}

std::optional<mapmatch::DirectedLink> SegmentLinks::find(std::int64_t node_a,
                                                         std::int64_t node_b) const {
  const auto found = links_.find({node_a, node_b});
  return found == links_.end() ? std::nullopt : std::optional(found->second);
}

void SegmentLinks::look_up(std::map<std::size_t, Label>& labels) const {
  for (auto& [row, label] : labels) label.link = find(label.node_a, label.node_b);
}

}  // namespace maploop::match
