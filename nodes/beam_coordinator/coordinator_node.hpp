#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "core/search/generate.hpp"
#include "nodes/beam_coordinator/job_pool.hpp"
#include "nodes/beam_coordinator/transition_publisher.hpp"
#include "nodes/bus/node_status.hpp"

namespace rtg::beam_coordinator {

/// The process that owns a generation: hands its work to workers and server, serves the transition
/// stream, says where it stands.
///
/// The search runs on a thread of its own and blocks in its seams, so that the bus is served while
/// it computes.
class CoordinatorNode {
 public:
  struct Options {
    jobs::TaskShape shape;
    std::int64_t config = 0;        // hash of the configuration
    long target = 0;                // transitions to be stored, for the display
    std::function<bool()> stopped;  // polled; true: end as soon as possible
  };

  CoordinatorNode(bus::Bus& bus, Options options);
  /// Tells workers and server to end.
  ~CoordinatorNode();
  CoordinatorNode(const CoordinatorNode&) = delete;
  CoordinatorNode& operator=(const CoordinatorNode&) = delete;

  using Search = std::function<search::GenerationReport(const search::GenerationSeams&)>;

  /// Runs `search` to its end and serves the bus meanwhile. Empty if it was stopped; rethrows what
  /// the search or a handler threw.
  std::optional<search::GenerationReport> run(const Search& search);

  /// Seals the stream and serves it until `consumers` and all others that are alive have it, or
  /// until stopped.
  void drain(int consumers);

  /// Units given up since they took down or stopped every worker that had them.
  long given_up() const { return reverse_.state().given_up + replay_.state().given_up; }

 private:
  search::GenerationSeams seams();
  void serve();
  void stop_search();
  void publish_progress();
  void publish_status();

  bus::Bus& bus_;
  Options options_;
  JobPool<jobs::ReverseService> reverse_;
  JobPool<jobs::ReplayService> replay_;
  TransitionPublisher transitions_;
  bus::NodeStatus status_;
  bus::Ticker progress_ticker_{0.5};
  bool leaving_ = false;
  mutable std::mutex mutex_;  // guards what follows
  search::Progress progress_{.phase = "starting"};
};

}  // namespace rtg::beam_coordinator
