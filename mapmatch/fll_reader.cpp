#include "mapmatch/fll_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "msgs/trimmed.h"

namespace maploop::mapmatch {
namespace {

std::vector<std::string> words(std::string_view text) {
  std::istringstream in{std::string(text)};
  std::vector<std::string> found;
  for (std::string word; in >> word;) found.push_back(word);
  return found;
}

struct OutputTerm {
  std::string name;
  double constant = 0.0;
  std::vector<double> slopes{};  // by variable
  std::optional<MembershipFunction> shape{};
};

struct Output {
  std::string name;
  std::vector<OutputTerm> terms{};
  Centroid centroid{};  // without steps: it is a mean
};

class Parser {
 public:
  Parser(std::string_view name, std::span<const std::string_view> inputs)
      : name_(name), inputs_(inputs), variables_(inputs.size()), defined_(inputs.size(), false) {}

  FuzzySystem parse(std::string_view text) {
    while (!text.empty()) {
      ++line_;
      const auto end = text.find('\n');
      take_line(text.substr(0, end));
      text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    }
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      if (!defined_[i]) fail("the input variable '" + std::string(inputs_[i]) + "' is missing");
    if (!output_) fail("there is no output variable");
    const bool mamdani = output_->centroid.steps > 0;
    for (const OutputTerm& term : output_->terms) {
      if (term.shape.has_value() != mamdani) {
        fail("the term '" + term.name +
             "' does not suit the defuzzifier: a centroid needs shapes, " +
             "a weighted average Constant or Linear terms");
      }
    }
    try {
      return {std::move(variables_), std::move(rules_),
              mamdani ? std::optional(output_->centroid) : std::nullopt};
    } catch (const std::invalid_argument& e) {
      fail(e.what());
    }
  }

 private:
  enum class Block { none, engine, input, output, rules };

  [[noreturn]] void fail(const std::string& what) const {
    throw FllError(std::string(name_) + ":" + std::to_string(line_) + ": " + what);
  }

  void take_line(std::string_view line) {
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) return;
    const auto colon = line.find(':');
    if (colon == std::string_view::npos) fail("a line must be 'key: value'");
    const std::string key(trimmed(line.substr(0, colon)));
    const std::string value(trimmed(line.substr(colon + 1)));
    if (!take_block(key, value)) take_key(key, value);
  }

  bool take_block(const std::string& key, const std::string& value) {
    if (block_ == Block::none && key != "Engine") fail("the file must start with 'Engine: NAME'");
    if (key == "Engine") {
      if (block_ != Block::none) fail("'Engine' must be the first line and occur once");
      block_ = Block::engine;
    } else if (key == "InputVariable") {
      const auto found = std::find(inputs_.begin(), inputs_.end(), value);
      if (found == inputs_.end()) {
        fail("'" + value +
             "' is not one of the input variables of this rule base:" + list(inputs_));
      }
      variable_ = static_cast<std::size_t>(found - inputs_.begin());
      if (defined_[variable_]) fail("the variable '" + value + "' is defined twice");
      defined_[variable_] = true;
      variables_[variable_].name = value;
      order_.push_back(variable_);
      block_ = Block::input;
    } else if (key == "OutputVariable") {
      if (output_) fail("there is a second output variable");
      output_ = Output{value};
      block_ = Block::output;
    } else if (key == "RuleBlock") {
      if (!rules_.empty()) fail("there is a second block of rules");
      block_ = Block::rules;
    } else {
      return false;
    }
    return true;
  }

  // Accepts the known keys; a fixed key must have the value that matches the evaluator.
  void take_key(const std::string& key, const std::string& value) {
    using Values = std::vector<std::string_view>;
    static const std::map<std::string_view, Values> fixed{
        {"enabled", {"true"}},
        {"lock-range", {"false"}},
        {"default", {"nan"}},
        {"lock-previous", {"false"}},
        {"aggregation", {"none", "Maximum"}},
        {"disjunction", {"none", ""}},
        {"implication", {"none", "", "Minimum"}},
        {"conjunction", {"Minimum"}},
        {"activation", {"General"}},
        {"defuzzifier", {"WeightedAverage TakagiSugeno", "WeightedAverage Automatic"}}};
    if (key == "description") return;
    if (key == "range" && (block_ == Block::input || block_ == Block::output)) {
      const auto range = numbers(words(value), 0, 2);
      if (block_ == Block::output) {
        output_->centroid.low = range[0];
        output_->centroid.high = range[1];
      }
    } else if (key == "term" && block_ == Block::input) {
      add_term(words(value));
    } else if (key == "term" && block_ == Block::output) {
      add_output_term(words(value));
    } else if (key == "rule" && block_ == Block::rules) {
      add_rule(value);
    } else if (key == "defuzzifier" && block_ == Block::output && value.starts_with("Centroid")) {
      const double steps = numbers(words(value), 1, 1).front();
      if (!(steps >= 1.0 && steps <= FuzzySystem::max_steps && steps == std::floor(steps)))
        fail("a centroid has 1 to " + std::to_string(FuzzySystem::max_steps) + " steps");
      output_->centroid.steps = static_cast<std::size_t>(steps);
    } else if (const auto found = fixed.find(key); found != fixed.end()) {
      if (std::find(found->second.begin(), found->second.end(), value) == found->second.end())
        fail("'" + key + "' can only be '" + std::string(found->second.front()) + "' here");
    } else {
      fail("'" + key + "' is not known here");
    }
  }

  std::vector<double> numbers(const std::vector<std::string>& given, std::size_t first,
                              std::size_t count) const {
    if (given.size() != first + count) {
      fail(std::to_string(count) + " numbers are needed, but " +
           std::to_string(given.size() - std::min(first, given.size())) + " are given");
    }
    std::vector<double> values;
    for (std::size_t i = first; i < given.size(); ++i) {
      double value = 0.0;
      const char* const end = given[i].data() + given[i].size();
      const auto [stop, error] = std::from_chars(given[i].data(), end, value);
      if (error != std::errc() || stop != end || !std::isfinite(value))
        fail("'" + given[i] + "' is not a finite number");
      values.push_back(value);
    }
    return values;
  }

  MembershipFunction shape(const std::vector<std::string>& given) const {
    using Shape = MembershipFunction::Shape;
    static const std::map<std::string_view, std::pair<Shape, std::size_t>> shapes{
        {"Sigmoid", {Shape::sigmoid, 2}},
        {"Ramp", {Shape::ramp, 2}},
        {"Triangle", {Shape::triangle, 3}},
        {"Trapezoid", {Shape::trapezoid, 4}}};
    const auto found = shapes.find(given[1]);
    if (found == shapes.end())
      fail("the shape '" + given[1] + "' is not Sigmoid, Ramp, Triangle or Trapezoid");
    MembershipFunction function{found->second.first, {}};
    const auto values = numbers(given, 2, found->second.second);
    std::copy(values.begin(), values.end(), function.parameters.begin());
    if (function.shape != Shape::sigmoid && function.shape != Shape::ramp &&
        !std::is_sorted(values.begin(), values.end()))
      fail("the corners of '" + given[0] + "' are not in ascending order");
    return function;
  }

  void add_term(const std::vector<std::string>& given) {
    if (given.size() < 2) fail("a term must be 'NAME SHAPE PARAMETERS'");
    FuzzyTerm term{given[0], shape(given)};
    if (++terms_ > FuzzySystem::max_terms)
      fail("more than " + std::to_string(FuzzySystem::max_terms) + " terms");
    auto& terms = variables_[variable_].terms;
    if (std::any_of(terms.begin(), terms.end(), [&](const auto& t) { return t.name == given[0]; }))
      fail("the term '" + given[0] + "' is defined twice");
    terms.push_back(std::move(term));
  }

  void add_output_term(const std::vector<std::string>& given) {
    if (given.size() < 2) {
      fail(
          "an output term must be 'NAME Constant VALUE', 'NAME Linear SLOPES VALUE' or "
          "'NAME SHAPE PARAMETERS'");
    }
    if (output_->terms.size() == FuzzySystem::max_terms)
      fail("more than " + std::to_string(FuzzySystem::max_terms) + " terms");
    if (output_term(given[0])) fail("the term '" + given[0] + "' is defined twice");
    OutputTerm term{given[0]};
    if (given[1] == "Constant") {
      term.constant = numbers(given, 2, 1).front();
    } else if (given[1] == "Linear") {
      // The slopes are in the order of the file's input variables.
      const auto values = numbers(given, 2, order_.size() + 1);
      term.slopes.resize(inputs_.size());
      for (std::size_t i = 0; i < order_.size(); ++i) term.slopes[order_[i]] = values[i];
      term.constant = values.back();
    } else {
      term.shape = shape(given);
    }
    output_->terms.push_back(std::move(term));
  }

  const OutputTerm* output_term(const std::string& name) const {
    for (const OutputTerm& term : output_->terms)
      if (term.name == name) return &term;
    return nullptr;
  }

  void add_rule(const std::string& text) {
    if (rules_.size() == FuzzySystem::max_rules)
      fail("more than " + std::to_string(FuzzySystem::max_rules) + " rules");
    const auto w = words(text);
    if (w.empty() || w[0] != "if") fail("a rule must start with 'if'");
    FuzzyRule rule;
    rule.text = text;
    std::size_t at = 1;
    do {
      rule.conditions.push_back(condition(w, at));
      at += 3;
    } while (at < w.size() && w[at++] == "and");
    if (w[at - 1] != "then" && (at >= w.size() || w[at] != "then"))
      fail("'and' or 'then' is expected after word " + std::to_string(at - 1));
    const bool weighted = w.size() == at + 5 && w[at + 3] == "with";
    if ((w.size() != at + 3 && !weighted) || w[at + 1] != "is")
      fail("only 'OUTPUT is TERM' or 'OUTPUT is TERM with WEIGHT' may follow 'then'");
    if (!output_ || w[at] != output_->name) fail("'" + w[at] + "' is not the output variable");
    const OutputTerm* term = output_term(w[at + 2]);
    if (!term) fail("'" + w[at + 2] + "' is not a term of '" + w[at] + "'");
    rule.output = term->constant;
    rule.slopes = term->slopes;
    rule.conclusion = term->shape.value_or(MembershipFunction{});
    if (weighted) rule.weight = numbers(w, at + 4, 1).front();
    if (rule.weight < 0.0) fail("a weight is not negative");
    rules_.push_back(std::move(rule));
  }

  FuzzyCondition condition(const std::vector<std::string>& w, std::size_t at) const {
    if (w.size() < at + 3 || w[at + 1] != "is") fail("a condition must be 'VARIABLE is TERM'");
    for (std::size_t v = 0; v < variables_.size(); ++v) {
      if (!defined_[v] || variables_[v].name != w[at]) continue;
      const auto& terms = variables_[v].terms;
      for (std::size_t t = 0; t < terms.size(); ++t)
        if (terms[t].name == w[at + 2]) return {v, t};
      fail("'" + w[at + 2] + "' is not a term of '" + w[at] + "'");
    }
    fail("'" + w[at] + "' is not an input variable");
  }

  template <class Names>
  static std::string list(const Names& names) {
    std::string text;
    for (const auto& name : names) text += " " + std::string(name);
    return text;
  }

  std::string_view name_;
  std::span<const std::string_view> inputs_;
  int line_ = 0;
  Block block_ = Block::none;
  std::vector<FuzzyVariable> variables_;
  std::vector<bool> defined_;
  std::vector<std::size_t> order_;  // the variables as the file has them
  std::size_t variable_ = 0;        // of the current block
  std::size_t terms_ = 0;           // of all input variables
  std::optional<Output> output_;
  std::vector<FuzzyRule> rules_;
};

}  // namespace

FuzzySystem parse_fll(std::string_view text, std::string_view name,
                      std::span<const std::string_view> inputs) {
  return Parser(name, inputs).parse(text);
}

FuzzySystem read_fll(const std::filesystem::path& file, std::span<const std::string_view> inputs) {
  try {
    return parse_fll(read_text(file, input_limits::settings), file.string(), inputs);
  } catch (const FileError& error) {
    throw FllError(std::string("cannot read the rules ") + error.what());
  }
}

}  // namespace maploop::mapmatch
