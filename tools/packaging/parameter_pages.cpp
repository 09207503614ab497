// Writes the files that are made from the descriptions of the parameters.
//
//   maploop_parameter_pages ROOT           writes them in the tree at ROOT
//   maploop_parameter_pages ROOT --check   status 1 where that would change any of them
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include "runtime/vehicle/config/config_tables.h"

namespace maploop::vehicle {
namespace {

// Below the mark a page is made here; above it, by hand.
constexpr std::string_view mark = "<!-- Below: made by maploop_parameter_pages -->\n";
constexpr std::string_view scheduling_meaning =
    "Policies of the threads of a vehicle and of a replay at the recorded pace; "
    "scheduling_config.h has their keys. A table [scheduling.fusion] means the same as the key "
    "fusion.";

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string default_file() {
  std::string text =
      "# Every parameter of maploop with its default. A file for --config needs only the keys\n"
      "# that differ; an unknown key is an error. Brackets hold what is allowed. Keys of "
      "[vehicle]\n"
      "# are comments: a value that is given holds against what a recording knows of its car.\n\n";
  std::string_view open;
  const auto begin = [&](std::string_view name, std::string_view meaning) {
    if (name != open) text += "\n# " + std::string(meaning) + "\n[" + std::string(name) + "]\n";
    open = name;
  };
  const auto add = [&](std::string_view key, const std::string& value, const std::string& range,
                       std::string_view meaning) {
    text += (open.starts_with("vehicle") ? "# " : "") + std::string(key) + " = " + value + "  # " +
            (range.empty() ? "" : '[' + range + "] ") + std::string(meaning) + '\n';
  };
  const VehicleConfig defaults;
  each_part(defaults, [&](const auto& table, const auto& values) {
    begin(table.name, table.meaning);
    for (const auto& p : table.parameters)
      add(p.key, text_of(p.value_in(values)), allowed_text(p), p.meaning);
  });
  begin("scheduling", scheduling_meaning);
  for (const ScheduledThread& thread : scheduled_threads()) {
    add(thread.key, toml_value(defaults.scheduling.*thread.scheduling), "", thread.meaning);
  }
  return text;
}

// A row of a Markdown table.
std::string row(std::initializer_list<std::string_view> cells) {
  std::string text = "|";
  for (const std::string_view cell : cells) {
    text += ' ';
    for (const char c : cell) text += c == '|' ? "\\|" : std::string(1, c);
    text += cell.empty() ? "|" : " |";
  }
  return text + '\n';
}

std::string code(std::string_view text) {
  return '`' + std::string(text) + '`';
}

std::string configuration_tables() {
  std::string text;
  std::string_view open = "none yet";
  const auto begin = [&](std::string_view name, std::string_view meaning) {
    if (name == open) return;
    open = name;
    text += name.empty() ? "\n## At the top level\n\n" : "\n## `[" + std::string(name) + "]`\n\n";
    if (!meaning.empty()) text += std::string(meaning) + "\n\n";
    text += row({"key", "default", "allowed", "meaning"}) + "|---|---|---|---|\n";
  };
  const VehicleConfig defaults;
  each_part(defaults, [&](const auto& table, const auto& values) {
    begin(table.name, table.meaning);
    for (const auto& p : table.parameters) {
      const std::string key =
          p.audience == Audience::usual ? "**" + code(p.key) + "**" : code(p.key);
      text += row({key, code(text_of(p.value_in(values))), allowed_text(p), p.meaning});
    }
  });
  begin("scheduling", scheduling_meaning);
  for (const ScheduledThread& thread : scheduled_threads()) {
    text += row({code(thread.key), code(toml_value(defaults.scheduling.*thread.scheduling)), "",
                 thread.meaning});
  }
  return text;
}

std::string chosen_parameters() {
  std::string text =
      '\n' + row({"parameter", "value", "chosen on", "how", "figures that are not unseen"}) +
      "|---|---|---|---|---|\n";
  const VehicleConfig defaults;
  each_part(defaults, [&](const auto& table, const auto& values) {
    for (const auto& p : table.parameters) {
      if (p.choice.data.empty()) continue;
      text += row({code(std::string(table.name) + '.' + std::string(p.key)),
                   text_of(p.value_in(values)), p.choice.data, p.choice.how, p.choice.figures});
    }
  });
  return text;
}

// The page with everything below its mark made anew.
std::string page(const std::filesystem::path& file, const std::string& below) {
  const std::string old = read(file);
  const std::size_t at = old.find(mark);
  if (at == std::string::npos) {
    throw std::runtime_error(file.string() + " has no line " + std::string(mark));
  }
  return old.substr(0, at + mark.size()) + below;
}

int write_pages(const std::filesystem::path& root, bool check) {
  const auto toml = root / "runtime/vehicle/config/maploop.toml";
  const auto configuration = root / "runtime/vehicle/CONFIGURATION.md";
  const auto chosen = root / "tools/PARAMETERS.md";
  int status = 0;
  for (const auto& [file, text] :
       {std::pair(toml, default_file()),
        std::pair(configuration, page(configuration, configuration_tables())),
        std::pair(chosen, page(chosen, chosen_parameters()))}) {
    if (read(file) == text) continue;
    if (!check && std::ofstream(file) << text) continue;
    std::cerr
        << file.string()
        << (check ? " is not what the parameters' descriptions say; run maploop_parameter_pages " +
                        root.string()
                  : " cannot be written")
        << '\n';
    status = 1;
  }
  return status;
}

}  // namespace
}  // namespace maploop::vehicle

int main(int count, char** words) try {
  const bool check = count == 3 && std::string_view(words[2]) == "--check";
  if (count != 2 && !check) {
    std::cerr << "usage: maploop_parameter_pages ROOT [--check]\n";
    return 2;
  }
  return maploop::vehicle::write_pages(words[1], check);
} catch (const std::exception& error) {
  std::cerr << "maploop_parameter_pages: " << error.what() << '\n';
  return 2;
}
