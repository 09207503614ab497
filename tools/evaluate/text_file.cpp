#include "tools/evaluate/text_file.h"

#include "msgs/whole_file.h"

namespace maploop::evaluation {

void write_text(const std::filesystem::path& file, const std::string& text) {
  write_whole_file(file, file.extension() == ".gz" ? gzip(text) : text);
}

}  // namespace maploop::evaluation
