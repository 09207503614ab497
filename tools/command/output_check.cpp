#include "tools/command/output_check.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace maploop::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* mark = "output";

struct Named {
  std::string option, value;
};

bool is_output(CLI::Option& option) {
  try {
    return option.get_validator(mark) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
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

[[noreturn]] void refuse(const Named& output, const std::string& why) {
  throw std::runtime_error("cannot write '" + output.value + "' (" + output.option + "): " + why +
                           "; give another name");
}

}  // namespace

CLI::Validator output_place() {
  return CLI::Validator([](std::string&) { return std::string{}; }, "", mark);
}

void check_outputs(CLI::App& app) {
  std::vector<Named> inputs, outputs;
  for (CLI::App* sub = &app; sub != nullptr;) {
    for (CLI::Option* option : sub->get_options()) {
      if (option->count() == 0) continue;
      auto& list = is_output(*option) ? outputs : inputs;
      for (const std::string& value : option->results())
        list.push_back({option->get_name(), value});
    }
    const auto subs = sub->get_subcommands();
    sub = subs.empty() ? nullptr : subs.front();
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (const Named& input : inputs) {
      if (same_file(outputs[i].value, input.value))
        refuse(outputs[i], "it is read (" + input.option + ")");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (same_file(outputs[i].value, outputs[j].value))
        refuse(outputs[i], outputs[j].option + " is written there");
    }
  }
}

}  // namespace maploop::tools
