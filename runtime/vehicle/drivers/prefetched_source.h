// Reads ahead, so that decoding is done before a sample falls due.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>

#include "runtime/core/doorbell.h"
#include "runtime/core/ring.h"
#include "runtime/core/thread.h"
#include "runtime/core/trace_span.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// Runs the given source on a loader thread of its own, up to `depth` samples ahead. next() swaps a
// loaded sample in, waits only when the loader is behind, and throws what ended the loader early.
// The loader ends at a request through `stop`, and with this object. report() waits until it has
// ended.
template <class T>
class PrefetchedSource final : public sensors::Source<T> {
 public:
  PrefetchedSource(std::string name, runtime::Scheduling scheduling,
                   std::unique_ptr<sensors::Source<T>> source, std::size_t depth,
                   std::stop_token stop, runtime::TraceBuffer* trace)
      : source_(std::move(source)),
        trace_(trace),
        loaded_(depth),
        stopped_(std::move(stop), [this] { end(); }),
        loader_(
            std::move(name), std::move(scheduling), end_.get_token(),
            [this](const std::stop_token& s) { load(s); },
            [this] {
              ended_.store(true, std::memory_order_release);
              filled_.ring();
            }) {}
  ~PrefetchedSource() override { end(); }

  bool next(T& sample) override {
    for (;;) {
      const std::uint32_t heard = filled_.listen();
      const bool ended = ended_.load(std::memory_order_acquire);
      if (T* slot = loaded_.front()) {
        std::swap(*slot, sample);
        loaded_.pop();
        taken_.ring();
        return true;
      }
      if (ended) {
        if (!loader_.failure().empty()) throw std::runtime_error(loader_.failure());
        return false;
      }
      filled_.wait(heard);
    }
  }

  const sensors::SourceReport& report() const override {
    for (;;) {
      const std::uint32_t heard = filled_.listen();
      if (ended_.load(std::memory_order_acquire)) return source_->report();
      filled_.wait(heard);
    }
  }

 private:
  void load(const std::stop_token& stop) {
    for (;;) {
      const std::uint32_t heard = taken_.listen();  // before the question: its bell is not missed
      if (stop.stop_requested()) return;
      T* slot = loaded_.claim();
      if (slot == nullptr) {
        taken_.wait(heard);
      } else {
        {
          const runtime::TraceSpan span(trace_, "decode");
          if (!source_->next(*slot)) return;
        }
        loaded_.publish();
        filled_.ring();
      }
    }
  }

  void end() {
    end_.request_stop();
    filled_.ring();
    taken_.ring();
  }

  std::unique_ptr<sensors::Source<T>> source_;
  runtime::TraceBuffer* trace_;
  runtime::Ring<T> loaded_;
  runtime::Doorbell filled_;
  runtime::Doorbell taken_;
  std::atomic<bool> ended_{false};
  std::stop_source end_;
  std::stop_callback<std::function<void()>> stopped_;
  runtime::Thread loader_;
};

}  // namespace maploop::vehicle
