#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "core/search/generate.hpp"
#include "nodes/beam_coordinator/job_pool.hpp"
#include "nodes/beam_coordinator/row_digest.hpp"
#include "nodes/beam_coordinator/transition_publisher.hpp"
#include "nodes/bus/node_status.hpp"

namespace rtg::beam_coordinator {

/// The coordinator process of a generation. It runs the search, sends jobs to workers and server,
/// serves the transition stream and publishes the progress.
///
/// The search has a thread of its own. It waits in its seams for the results of jobs, while run()
/// serves the bus.
class CoordinatorNode {
 public:
  struct Options {
    jobs::TaskShape shape;
    std::int64_t config = 0;        // hash of the configuration
    long target = 0;                // number of transitions to store, for the display
    std::function<bool()> stopped;  // polled; true: end as soon as possible
    // Of the answers of workers and server; null: a search that begins anew asks for all of them.
    jobs::UnitJournal* journal = nullptr;
  };

  CoordinatorNode(bus::Bus& bus, Options options);
  /// Tells workers and server to end.
  ~CoordinatorNode();
  CoordinatorNode(const CoordinatorNode&) = delete;
  CoordinatorNode& operator=(const CoordinatorNode&) = delete;

  using Search = std::function<search::GenerationReport(const search::GenerationSeams&)>;

  /// Runs `search` on its thread and serves the bus until it ends. Returns nothing if the node was
  /// stopped. Rethrows an exception of the search or of a handler.
  std::optional<search::GenerationReport> run(const Search& search);

  /// Marks the transition stream as complete. Serves it until all living consumers, and at least
  /// `consumers`, have all of it. Returns early if the node is stopped.
  void drain(int consumers);

 private:
  /// Returns the number of units given up because several workers that had them were lost.
  long given_up() const { return reverse_.state().given_up + replay_.state().given_up; }

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
  RowDigest digest_;  // of the stream; the thread of the search adds to it
  bus::NodeStatus status_;
  bus::Ticker progress_ticker_{0.5};
  bool served_ = false;  // a worker or the server has been heard
  bool leaving_ = false;
  mutable std::mutex mutex_;  // guards the members below
  search::Progress progress_{.phase = "starting"};
};

}  // namespace rtg::beam_coordinator
