// The rings of one vehicle, made from their declaration (ring_specs.h).
#pragma once

#include <algorithm>
#include <initializer_list>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/vehicle/graph/ring_specs.h"
#include "runtime/vehicle/graph/stage_specs.h"

namespace maploop::vehicle {

// The producer's end of all rings that get the same samples. One thread's own.
template <class T>
class Outputs {
 public:
  void add(runtime::Edge<T>* ring) {
    if (ring != nullptr) rings_.push_back(ring);
  }
  const std::vector<runtime::Edge<T>*>& rings() const { return rings_; }
  void push(const T& sample, const std::stop_token& stop) const {
    for (runtime::Edge<T>* ring : rings_) ring->push(sample, stop);
  }

 private:
  std::vector<runtime::Edge<T>*> rings_;
};

// Each ring is taken by its consumer and its producer before the threads run; check() finds one
// that was forgotten. Must outlive the stages.
class Rings {
 public:
  // The rings of `table` (a tuple of RingSpec) between the `stages` (by name) of this vehicle, of
  // those that have `needs` only the ones whose needs are met.
  template <class Table>
  Rings(const Table& table, std::set<std::string_view> stages, std::set<RingNeeds> met)
      : stages_(std::move(stages)), met_(std::move(met)) {
    met_.insert(RingNeeds::both_ends);
    std::apply([this](const auto&... spec) { (this->make(spec), ...); }, table);
  }

  bool has(const StageSpec& stage) const { return stages_.contains(stage.name); }

  // The consumer's end; nullptr: this vehicle does not have the ring.
  template <class T>
  runtime::Edge<T>* consumer(const RingSpec<T>& spec) {
    Made* made = find(&spec);
    if (made == nullptr) return nullptr;
    made->consumed = true;
    return static_cast<runtime::Edge<T>*>(made->ring.get());
  }

  // The producer's end of those of the rings that this vehicle has.
  template <class T, class... More>
  Outputs<T> outputs(const RingSpec<T>& first, const More&... more) {
    Outputs<T> outputs;
    outputs.add(producer(first));
    (outputs.add(producer(more)), ...);
    return outputs;
  }

  // It is rung at each sample and each promise in a ring to this stage.
  runtime::Doorbell& bell(const StageSpec& stage) { return bells_[stage.name]; }

  const std::vector<runtime::EdgeBase*>& all() const { return all_; }

  // Throws std::logic_error, naming a ring that lacks its producer or its consumer.
  void check() const {
    for (const auto& [spec, made] : made_) {
      if (made.consumed && made.produced) continue;
      throw std::logic_error("the ring '" + made.ring->health().name + "' has no " +
                             (made.consumed ? "producer" : "consumer"));
    }
  }

 private:
  struct Made {
    std::unique_ptr<runtime::EdgeBase> ring;
    bool consumed = false;
    bool produced = false;
  };

  template <class T>
  void make(const RingSpec<T>& spec) {
    if (!has(spec.from) || !has(spec.to) || !met_.contains(spec.needs)) return;
    if (spec.instead_of != nullptr && has(*spec.instead_of)) return;
    runtime::Doorbell* wakes = spec.to.polls ? nullptr : &bell(spec.to);
    auto ring = std::make_unique<runtime::Edge<T>>(spec.name(), spec.capacity, spec.overflow, wakes,
                                                   rings::prototype<T>());
    all_.push_back(ring.get());
    made_.emplace(&spec, Made{std::move(ring)});
  }

  template <class T>
  runtime::Edge<T>* producer(const RingSpec<T>& spec) {
    Made* made = find(&spec);
    if (made == nullptr) return nullptr;
    made->produced = true;
    return static_cast<runtime::Edge<T>*>(made->ring.get());
  }

  Made* find(const void* spec) {
    const auto found = made_.find(spec);
    return found != made_.end() ? &found->second : nullptr;
  }

  std::set<std::string_view> stages_;
  std::set<RingNeeds> met_;
  std::map<std::string_view, runtime::Doorbell> bells_;
  std::map<const void*, Made> made_;  // by the address of the RingSpec, which names its type
  std::vector<runtime::EdgeBase*> all_;
};

}  // namespace maploop::vehicle
