// A plugin of QEMU 7.2's user-mode emulators (docs/devel/tcg-plugins.rst of QEMU describes the
// interface): it writes how many instructions the threads of each name have executed, as lines
// "NAME INSTRUCTIONS", to the file that `out=FILE` names.
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

// This is the part of the interface that is used here, as Debian has no package with its header.
extern "C" {
using qemu_plugin_id_t = std::uint64_t;
struct qemu_plugin_tb;
struct qemu_info_t;
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t,
                                           void (*)(qemu_plugin_id_t, qemu_plugin_tb*));
void qemu_plugin_register_vcpu_tb_exec_cb(qemu_plugin_tb*, void (*)(unsigned int, void*), int flags,
                                          void* user);
void qemu_plugin_register_vcpu_syscall_cb(qemu_plugin_id_t,
                                          void (*)(qemu_plugin_id_t, unsigned int, std::int64_t,
                                                   std::uint64_t, std::uint64_t, std::uint64_t,
                                                   std::uint64_t, std::uint64_t, std::uint64_t,
                                                   std::uint64_t, std::uint64_t));
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t, void (*)(qemu_plugin_id_t, void*),
                                    void* user);
std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb*);

// The emulator looks these up in the plugin.
[[gnu::visibility("default")]] extern const int qemu_plugin_version;
[[gnu::visibility("default")]] int qemu_plugin_install(qemu_plugin_id_t, const qemu_info_t*, int,
                                                       char**);
}

namespace {

// The emulator gives each thread a number, of which each counts for itself. The number of a thread
// that has ended is given to another.
struct alignas(64) Thread {
  std::uint64_t instructions;
  pid_t id;
  std::array<char, 16> name;
};
std::array<Thread, 4096> threads;
std::mutex mutex;
std::map<std::string, std::uint64_t> of_name;  // guarded by `mutex`
std::string file;

void add_count(Thread& thread) {
  const std::lock_guard lock(mutex);
  of_name[thread.name.data()] += std::exchange(thread.instructions, 0);
}

void execute(unsigned int thread, void* instructions) {
  threads.at(thread).instructions += reinterpret_cast<std::uintptr_t>(instructions);
}

void translate(qemu_plugin_id_t, qemu_plugin_tb* block) {
  // The number itself is the word that the emulator hands back.
  void* instructions =
      reinterpret_cast<void*>(qemu_plugin_tb_n_insns(block));  // NOLINT(performance-no-int-to-ptr)
  qemu_plugin_register_vcpu_tb_exec_cb(block, execute, 0, instructions);
}

// A thread of the program is one of the emulator, which has the same name: it is read at each call
// of the system, as the last one of a thread comes after it has taken its name.
void call_system(qemu_plugin_id_t, unsigned int number, std::int64_t, std::uint64_t, std::uint64_t,
                 std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t,
                 std::uint64_t) {
  Thread& thread = threads.at(number);
  if (thread.id != gettid()) {
    add_count(thread);
    thread.id = gettid();
  }
  pthread_getname_np(pthread_self(), thread.name.data(), thread.name.size());
}

void write_counts(qemu_plugin_id_t, void*) {
  for (Thread& thread : threads) add_count(thread);
  std::FILE* out = std::fopen(file.c_str(), "w");
  if (!out) return std::perror(file.c_str());
  for (const auto& [name, instructions] : of_name) {
    if (!name.empty())
      std::fprintf(out, "%s %llu\n", name.c_str(), static_cast<unsigned long long>(instructions));
  }
  if (std::fclose(out) != 0) std::perror(file.c_str());
}

}  // namespace

extern "C" {
const int qemu_plugin_version = 1;

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t*, int argc, char** argv) {
  for (int i = 0; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.starts_with("out=")) file = argument.substr(4);
  }
  if (file.empty()) {
    std::fputs("count_instructions: out=FILE is missing\n", stderr);
    return 1;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
  qemu_plugin_register_vcpu_syscall_cb(id, call_system);
  qemu_plugin_register_atexit_cb(id, write_counts, nullptr);
  return 0;
}
}
