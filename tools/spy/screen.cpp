#include "tools/spy/screen.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tools/spy/text.h"

namespace maploop::spy {
namespace {

constexpr char escape = '\x1b';
constexpr std::size_t page = 10;
constexpr const char* help = "up/down: channel   PgUp/PgDn: fields   /: filter   q: quit";

// The lines of one picture, cut to the terminal's width.
class Lines {
 public:
  Lines(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns) {}

  std::size_t left() const { return rows_ - std::min(rows_, used_); }
  void add(const std::string& line, const char* attribute = "") {
    if (left() == 0) return;
    if (used_++ > 0) text_ += "\r\n";
    text_ += attribute + line.substr(0, columns_) + "\x1b[0m\x1b[K";
  }
  const std::string& text() const { return text_; }

 private:
  std::size_t rows_, columns_, used_ = 0;
  std::string text_;
};

constexpr const char* bold = "\x1b[1m";
constexpr const char* reverse = "\x1b[7m";

}  // namespace

lcm_log::ChannelFilter filter_of(const std::string& expression) {
  lcm_log::matching(expression);  // throws for ")(", which the next line would hide
  return lcm_log::matching(expression.empty() ? ".*" : ".*(" + expression + ").*");
}

void Screen::press(char key) {
  if (key == escape) {
    sequence_ = key;  // alone it ends the typing; the sequence of an arrow continues
    typing_ = false;
    return;
  }
  if (sequence_.empty()) return type(key);
  sequence_ += key;
  if (sequence_.size() == 2) {
    if (key == '[' || key == 'O') return;
    sequence_.clear();
    return type(key);  // the escape was a key of its own
  }
  if (key < '@' || key > '~') return;  // the sequence continues
  const std::string code = std::exchange(sequence_, {}).substr(2);
  if (code == "A") --moves_;
  if (code == "B") ++moves_;
  if (code == "5~") first_field_ -= std::min(first_field_, page);
  if (code == "6~") first_field_ += page;
}

void Screen::type(char key) {
  if (!typing_) {
    if (key == 'q') quit_ = true;
    if (key != '/') return;
    typing_ = true;
    typed_ = expression_;
    complaint_.clear();
    return;
  }
  if (key == '\r' || key == '\n') {
    typing_ = false;
    try {
      filter_ = filter_of(typed_);
      expression_ = typed_;
    } catch (const std::invalid_argument& e) {
      complaint_ = e.what();
    }
  } else if (key == '\x7f' || key == '\b') {
    if (!typed_.empty()) typed_.pop_back();
  } else if (key >= ' ') {
    typed_ += key;
  }
}

std::string Screen::picture(const Traffic& traffic, Duration now, std::size_t rows,
                            std::size_t columns) {
  const std::vector<ChannelStatus> channels = traffic.status(now, filter_);
  const auto named = std::find_if(channels.begin(), channels.end(),
                                  [&](const auto& c) { return c.name == selected_; });
  long at = named == channels.end() ? 0 : named - channels.begin();
  at = std::clamp(at + std::exchange(moves_, 0), 0L,
                  std::max(0L, static_cast<long>(channels.size()) - 1));
  const auto index = static_cast<std::size_t>(at);
  const std::string selected = channels.empty() ? std::string() : channels[index].name;
  if (selected != selected_) first_field_ = 0;
  selected_ = selected;

  Lines lines(rows - std::min<std::size_t>(rows, 1), columns);  // the last row shows the help
  std::string title = "maploop spy  " + printable(source_) + "  " +
                      std::to_string(channels.size()) + " channels, " +
                      std::to_string(traffic.count()) + " messages";
  if (!expression_.empty()) title += "  filter: " + printable(expression_);
  if (traffic.elsewhere() > 0) title += "  (and more channels than are told apart)";
  lines.add(title, bold);
  for (const std::string& line : vehicle_lines(traffic)) lines.add(line);
  if (channels.empty()) {
    lines.add(traffic.count() == 0 ? "nothing heard yet"
                                   : "no channel's name has the filter in it");
  } else {
    lines.add(table_header(), bold);
    const std::size_t shown = std::min(channels.size(), std::max<std::size_t>(lines.left() / 2, 3));
    const std::size_t first = std::min(index - std::min(index, shown / 2), channels.size() - shown);
    for (std::size_t i = first; i < first + shown; ++i) {
      lines.add(table_row(channels[i]), i == index ? reverse : "");
    }
    lines.add("");
    const std::vector<std::string> fields = field_lines(traffic.schema(), traffic.last(selected_));
    first_field_ = std::min(first_field_, fields.size() - std::min<std::size_t>(fields.size(), 1));
    lines.add(printable(selected_) + ", " + std::to_string(fields.size()) + " fields" +
                  (first_field_ > 0 ? " from " + std::to_string(first_field_ + 1) : ""),
              bold);
    for (std::size_t i = first_field_; i < fields.size() && lines.left() > 0; ++i) {
      lines.add(fields[i]);
    }
  }
  const std::string prompt = typing_              ? "/" + printable(typed_) + "_"
                             : complaint_.empty() ? std::string(help)
                                                  : printable(complaint_);
  return "\x1b[H" + lines.text() + "\x1b[J\x1b[" + std::to_string(rows) + ";1H" +
         prompt.substr(0, columns) + "\x1b[K";
}

}  // namespace maploop::spy
