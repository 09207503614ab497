#include "tools/log/log_writer.h"

#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "msgs/lcm/log/log_header.h"

namespace maploop::lcm_log {

struct LogWriter::Stream {
  ~Stream() {
    if (file != nullptr) gzclose_w(file);
  }
  gzFile file = nullptr;
};

LogWriter::LogWriter(const std::filesystem::path& file)
    : file_(file), part_(file.string() + ".part"), stream_(std::make_unique<Stream>()) {
  // A folder, or a device such as /dev/null, must not be replaced by a file.
  std::error_code missing;
  const auto status = std::filesystem::status(file, missing);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    fail("it is no regular file");
  }
  const bool compressed = file.extension() == ".gz";
  stream_->file = gzopen(part_.c_str(), compressed ? "wb6" : "wbT");
  if (stream_->file == nullptr) fail(std::strerror(errno));
  gzbuffer(stream_->file, 256 * 1024);
}

LogWriter::~LogWriter() {
  if (stream_->file == nullptr) return;
  stream_.reset();
  std::error_code ignored;  // a destructor cannot report an error
  std::filesystem::remove(part_, ignored);
}

void LogWriter::fail(const char* why) {
  throw std::runtime_error("cannot write the log '" + file_.string() + "': " + why +
                           "; does its folder exist, and has the disk room?");
}

void LogWriter::put(const void* bytes, std::size_t size) {
  if (size == 0) return;
  errno = 0;
  const int written = gzwrite(stream_->file, bytes, static_cast<unsigned>(size));
  if (written != static_cast<int>(size)) fail(errno != 0 ? std::strerror(errno) : "write failed");
  bytes_ += size;
}

void LogWriter::write(const LogEvent& event) {
  std::array<std::uint8_t, kHeaderBytes> header{};
  write_header({.sync = kSyncWord,
                .number = events_,
                .time_us = event.time_us,
                .channel_bytes = static_cast<std::int32_t>(event.channel.size()),
                .data_bytes = static_cast<std::int32_t>(event.data.size())},
               header);
  put(header.data(), header.size());
  put(event.channel.data(), event.channel.size());
  put(event.data.data(), event.data.size());
  ++events_;
}

void LogWriter::close() {
  errno = 0;
  const int closed = gzclose_w(std::exchange(stream_->file, nullptr));
  std::error_code error;
  if (closed == Z_OK) std::filesystem::rename(part_, file_, error);
  if (closed == Z_OK && !error) return;
  const std::string why = error        ? error.message()
                          : errno != 0 ? std::strerror(errno)
                                       : "write failed";
  std::filesystem::remove(part_, error);
  fail(why.c_str());
}

void refuse_same_file(const std::filesystem::path& input, const std::filesystem::path& output) {
  std::error_code error;
  if (std::filesystem::equivalent(input, output, error)) {
    throw std::invalid_argument("'" + output.string() +
                                "' is read and cannot be the output too: name another output file");
  }
}

}  // namespace maploop::lcm_log
