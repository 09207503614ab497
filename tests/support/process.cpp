#include "tests/support/process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace maploop::testing {
namespace {

std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// Returns the command that starts a program. A program beside this one may have been built for
// another processor; MAPLOOP_EMULATOR then names the emulator that runs it.
std::vector<std::string> as_started(const std::vector<std::string>& command) {
  const char* emulator = std::getenv("MAPLOOP_EMULATOR");
  const auto own = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  if (emulator == nullptr || std::filesystem::path(command[0]).parent_path() != own) return command;
  std::istringstream words(emulator);
  std::vector<std::string> started{std::istream_iterator<std::string>(words), {}};
  started.insert(started.end(), command.begin(), command.end());
  return started;
}

}  // namespace

std::string maploop_command() {
  return std::filesystem::read_symlink("/proc/self/exe").replace_filename("maploop").string();
}

bool comes_to_contain(const std::filesystem::path& file, const std::string& text, int times) {
  for (int i = 0; i < 600; ++i) {
    const std::string all = content(file);
    int found = 0;
    for (auto at = all.find(text); at != std::string::npos; at = all.find(text, at + 1)) ++found;
    if (found >= times) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

Process::Process(const std::vector<std::string>& command) {
  const std::vector<std::string> started = as_started(command);
  std::vector<char*> arguments;
  arguments.reserve(started.size() + 1);
  for (const std::string& word : started) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  const std::string out = (folder_.path() / "out").string();
  const std::string error = (folder_.path() / "error").string();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, error.c_str(), O_WRONLY | O_CREAT,
                                   0600);
  const int failed = posix_spawnp(&id_, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    id_ = 0;
    throw std::runtime_error("cannot start " + command[0] + ": " + std::strerror(failed));
  }
}

Process::~Process() {
  if (id_ == 0) return;
  kill(id_, SIGKILL);
  waitpid(id_, nullptr, 0);
}

void Process::send_signal(int signal) const {
  kill(id_, signal);
}

bool Process::runs() const {
  siginfo_t ended{};
  waitid(P_PID, static_cast<id_t>(id_), &ended, WEXITED | WNOHANG | WNOWAIT);
  return ended.si_pid == 0;
}

ProcessResult Process::wait() {
  int status = 0;
  waitpid(id_, &status, 0);
  id_ = 0;
  ProcessResult result;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = content(folder_.path() / "out");
  result.error = content(folder_.path() / "error");
  return result;
}

}  // namespace maploop::testing
