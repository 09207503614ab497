#include "runtime/core/trace.h"

#include <utility>

#include "runtime/core/parameter_table.h"
#include "runtime/core/trace_json.h"

namespace maploop::runtime {

Tracer::Tracer(const TraceParameters& parameters)
    : events_per_thread_(static_cast<std::size_t>(parameters.events_per_thread)),
      start_(monotonic_now()) {
  validate_parameters(parameters);
}

TraceBuffer& Tracer::thread(std::string name) {
  auto buffer = std::make_unique<TraceBuffer>(std::move(name), events_per_thread_);
  const std::lock_guard lock(mutex_);
  return *buffers_.emplace_back(std::move(buffer));
}

TraceName Tracer::name(std::string_view text) {
  const std::lock_guard lock(mutex_);
  return TraceName(TraceName::Owned{names_.emplace(text).first->c_str()});
}

std::uint64_t Tracer::recorded() const {
  const std::lock_guard lock(mutex_);
  std::uint64_t sum = 0;
  for (const auto& buffer : buffers_) sum += buffer->recorded();
  return sum;
}

std::uint64_t Tracer::dropped() const {
  const std::lock_guard lock(mutex_);
  std::uint64_t sum = 0;
  for (const auto& buffer : buffers_) sum += buffer->dropped();
  return sum;
}

void Tracer::write(const std::filesystem::path& file) const {
  std::vector<const TraceBuffer*> buffers;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& buffer : buffers_) buffers.push_back(buffer.get());
  }
  write_trace_json(file, start_, buffers);
}

}  // namespace maploop::runtime
