// Our ring against boost::lockfree::spsc_queue and moodycamel::ReaderWriterQueue, in one run.
//
// Run, on an otherwise idle machine, with each name once a round and the rounds interleaved:
//   build/release/bin/ring_benchmark --benchmark_repetitions=9
//     --benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true
//
// Two threads, each pinned to a core of its own; every queue has room for 1024 items (throughput)
// and has been filled and emptied before the clock starts, so that its pages are mapped and its
// indices wrap. Every item is written whole, read whole and checked. Ours and moodycamel are read
// in place; boost, which offers that too by consume_one, as well. throughput is items a second;
// round_trip is the time of one item there and back through two queues.
#include <benchmark/benchmark.h>
#include <pthread.h>
#include <readerwriterqueue/readerwriterqueue.h>

#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <cstdint>
#include <thread>

#include "runtime/core/ring.h"

namespace {

constexpr std::size_t ring_capacity = 1024;

void pin_to_core(int core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core, &cores);
  pthread_setaffinity_np(pthread_self(), sizeof cores, &cores);
}

template <std::size_t item_bytes>
using Item = std::array<std::uint64_t, item_bytes / sizeof(std::uint64_t)>;

// All queues in one form: put(value) fills an item with it, take(sum) adds an item's words up.
template <typename T>
std::uint64_t sum_of(const T& item) {
  std::uint64_t sum = 0;
  for (std::uint64_t word : item) sum += word;
  return sum;
}

template <typename T>
class Ours {
 public:
  bool put(std::uint64_t value) {
    T* slot = ring_.claim();
    if (slot == nullptr) return false;
    slot->fill(value);
    ring_.publish();
    return true;
  }
  bool take(std::uint64_t& sum) {
    const T* item = ring_.front();
    if (item == nullptr) return false;
    sum = sum_of(*item);
    ring_.pop();
    return true;
  }

 private:
  maploop::runtime::Ring<T> ring_{ring_capacity};
};

template <typename T>
class Boost {
 public:
  bool put(std::uint64_t value) {
    T item;
    item.fill(value);
    return queue_.push(item);
  }
  bool take(std::uint64_t& sum) {
    return queue_.consume_one([&sum](const T& item) { sum = sum_of(item); });
  }

 private:
  boost::lockfree::spsc_queue<T> queue_{ring_capacity};
};

template <typename T>
class Moodycamel {
 public:
  bool put(std::uint64_t value) {
    T item;
    item.fill(value);
    return queue_.try_enqueue(item);
  }
  bool take(std::uint64_t& sum) {
    const T* item = queue_.peek();
    if (item == nullptr) return false;
    sum = sum_of(*item);
    queue_.pop();
    return true;
  }

 private:
  moodycamel::ReaderWriterQueue<T> queue_{ring_capacity};
};

template <typename Queue>
void fill_and_empty(Queue& queue) {
  std::uint64_t sum = 0;
  for (int lap = 0; lap < 3; ++lap) {
    while (queue.put(0)) {
    }
    while (queue.take(sum)) {
    }
  }
}

template <template <typename> class Queue, std::size_t item_bytes>
void throughput(benchmark::State& state) {
  constexpr std::uint64_t item_count = 20'000'000 / (item_bytes / 8 + 3);
  constexpr std::uint64_t word_count = item_bytes / 8;
  pin_to_core(0);
  for (auto _ : state) {
    Queue<Item<item_bytes>> queue;
    fill_and_empty(queue);
    std::atomic<bool> ready{false}, go{false};
    std::uint64_t wrong = 0;
    std::thread consumer([&] {
      pin_to_core(1);
      ready = true;
      while (!go) {
      }
      for (std::uint64_t i = 0; i < item_count; ++i) {
        std::uint64_t sum = 0;
        while (!queue.take(sum)) {
        }
        wrong += sum != i * word_count ? 1 : 0;
      }
    });
    while (!ready) {
    }
    const auto start = std::chrono::steady_clock::now();
    go = true;
    for (std::uint64_t i = 0; i < item_count; ++i) {
      while (!queue.put(i)) {
      }
    }
    consumer.join();
    const auto end = std::chrono::steady_clock::now();
    state.SetIterationTime(std::chrono::duration<double>(end - start).count());
    if (wrong != 0) state.SkipWithError("items were lost, torn or out of order");
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(item_count));
}

template <template <typename> class Queue, std::size_t item_bytes>
void round_trip(benchmark::State& state) {
  constexpr std::uint64_t word_count = item_bytes / 8;
  Queue<Item<item_bytes>> there, back;
  fill_and_empty(there);
  fill_and_empty(back);
  std::atomic<bool> done{false};
  pin_to_core(0);
  std::thread echo([&] {
    pin_to_core(1);
    for (std::uint64_t sum = 0;;) {
      while (!there.take(sum)) {
        if (done) return;
      }
      while (!back.put(sum / word_count)) {
      }
    }
  });
  std::uint64_t i = 0, wrong = 0;
  for (auto _ : state) {
    std::uint64_t sum = 0;
    while (!there.put(i)) {
    }
    while (!back.take(sum)) {
    }
    wrong += sum != i++ * word_count ? 1 : 0;
  }
  done = true;
  echo.join();
  if (wrong != 0) state.SkipWithError("an item came back changed");
}

#define MAPLOOP_COMPARE(bytes)                               \
  BENCHMARK(throughput<Ours, bytes>)->UseManualTime();       \
  BENCHMARK(throughput<Boost, bytes>)->UseManualTime();      \
  BENCHMARK(throughput<Moodycamel, bytes>)->UseManualTime(); \
  BENCHMARK(round_trip<Ours, bytes>)->UseRealTime();         \
  BENCHMARK(round_trip<Boost, bytes>)->UseRealTime();        \
  BENCHMARK(round_trip<Moodycamel, bytes>)->UseRealTime()

MAPLOOP_COMPARE(8);
MAPLOOP_COMPARE(64);
MAPLOOP_COMPARE(256);

}  // namespace

BENCHMARK_MAIN();
