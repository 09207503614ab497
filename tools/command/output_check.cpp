#include "tools/command/output_check.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace maploop::tools {
namespace {

namespace fs = std::filesystem;

// These are the names of the validators that mark an output, by OutputName.
constexpr std::array marks{"output", "output after a colon", "output with .ppp"};

struct Named {
  std::string option, value;
  bool is_read_too = false;  // what an earlier run wrote there
};

std::optional<OutputName> output_name(CLI::Option& option) {
  // An option that also names a second file has the first mark, too.
  for (std::size_t i = marks.size(); i-- > 0;) {
    try {
      if (option.get_validator(marks[i]) != nullptr) return static_cast<OutputName>(i);
    } catch (const CLI::OptionNotFound&) {
    }
  }
  return std::nullopt;
}

std::vector<std::string> files_of(const std::string& value, OutputName name) {
  if (name == OutputName::after_colon) return {value.substr(value.find(':') + 1)};
  if (name == OutputName::with_ppp) return {value, value + ".ppp"};
  return {value};
}

// Whether both name one file, which need not be there yet.
bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  const fs::path first = fs::weakly_canonical(fs::absolute(a, error), error);
  if (error) return false;
  const fs::path second = fs::weakly_canonical(fs::absolute(b, error), error);
  if (error) return false;
  if (fs::exists(first, error) && !fs::is_regular_file(first, error)) return false;
  return first == second || fs::equivalent(first, second, error);
}

// Whether the file is there, in this folder or in one below.
bool lies_in(const std::string& file, const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error) || !fs::is_regular_file(file, error)) return false;
  const fs::path below =
      fs::canonical(file, error).lexically_relative(fs::canonical(folder, error));
  return !error && !below.empty() && *below.begin() != "..";
}

[[noreturn]] void refuse(const Named& output, const std::string& why) {
  throw std::runtime_error("cannot write '" + output.value + "' (" + output.option + "): " + why +
                           "; give another name");
}

}  // namespace

CLI::Validator output_place(OutputName name) {
  return CLI::Validator([](std::string&) { return std::string{}; }, "",
                        marks[static_cast<std::size_t>(name)]);
}

void check_outputs(CLI::App& app) {
  std::vector<Named> inputs, outputs;
  for (CLI::App* sub = &app; sub != nullptr;) {
    for (CLI::Option* option : sub->get_options()) {
      const std::optional<OutputName> name = output_name(*option);
      std::vector<std::string> values = option->results();
      if (values.empty() && name && !option->get_default_str().empty())
        values.push_back(option->get_default_str());
      for (const std::string& value : values) {
        if (!name) inputs.push_back({option->get_name(), value});
        for (const std::string& file : name ? files_of(value, *name) : std::vector<std::string>())
          outputs.push_back({option->get_name(), file, name == OutputName::with_ppp});
      }
    }
    const auto subs = sub->get_subcommands();
    sub = subs.empty() ? nullptr : subs.front();
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (const Named& input : inputs) {
      if (same_file(outputs[i].value, input.value))
        refuse(outputs[i], "it is read (" + input.option + ")");
      if (!outputs[i].is_read_too && lies_in(outputs[i].value, input.value)) {
        refuse(outputs[i], "it is there in the folder '" + input.value +
                               "', which is read; remove it first if it is an earlier result");
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (same_file(outputs[i].value, outputs[j].value))
        refuse(outputs[i], outputs[j].option + " is written there");
    }
  }
}

}  // namespace maploop::tools
