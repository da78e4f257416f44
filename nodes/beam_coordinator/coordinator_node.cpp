#include "nodes/beam_coordinator/coordinator_node.hpp"

#include <atomic>
#include <exception>
#include <rtg_msgs/search_progress_t.hpp>
#include <thread>
#include <utility>

#include "nodes/program/program.hpp"

namespace rtg::beam_coordinator {
namespace {

using namespace std::chrono_literals;

constexpr auto kWait = 50ms;        // longest wait for a message before timers are checked
constexpr auto kBacklogWait = 5ms;  // the same while rows of the stream wait to be sent
constexpr int kFarewells = 5;       // messages with `leaving` set; a worker ends at the first one
constexpr auto kFarewellWait = 40ms;

/// Returns the identity of the stream. With a journal, a coordinator that is started again goes on
/// with the same rows. Without one it may have to give up other units, so that rows differ.
std::int64_t stream_of(const jobs::UnitJournal* journal) {
  return journal ? journal->generation() : bus::random_identity();
}

}  // namespace

CoordinatorNode::CoordinatorNode(bus::Bus& bus, Options options)
    : bus_(bus),
      options_(std::move(options)),
      reverse_(bus, options_.shape, options_.config, {}, options_.journal),
      replay_(bus, options_.shape, options_.config, {}, options_.journal),
      transitions_(bus, options_.shape, stream_of(options_.journal)),
      status_(bus, "beam_coordinator", 0) {
  progress_.target = options_.target;
}

CoordinatorNode::~CoordinatorNode() {
  leaving_ = true;
  for (int k = 0; k < kFarewells; ++k) {
    publish_progress();
    std::this_thread::sleep_for(kFarewellWait);
  }
}

std::optional<search::GenerationReport> CoordinatorNode::run(const Search& search) {
  std::optional<search::GenerationReport> report;
  std::exception_ptr failure;
  std::atomic<bool> ended = false;
  std::jthread thread([&] {
    try {
      report = search(seams());
    } catch (const Interrupted&) {
    } catch (...) {
      failure = std::current_exception();
    }
    ended = true;
  });
  try {
    while (!ended) serve();
  } catch (...) {
    stop_search();
    throw;
  }
  thread.join();
  if (failure) std::rethrow_exception(failure);
  if (options_.stopped()) report.reset();
  if (report) {
    report->units_given_up = given_up();
    report->rows_sha256 = digest_.hex();
  }
  return report;
}

void CoordinatorNode::drain(int consumers) {
  transitions_.seal();
  {
    const std::scoped_lock lock(mutex_);
    progress_.phase = "finished";
  }
  while (!options_.stopped() && !transitions_.drained(consumers, bus::monotonic_now())) serve();
}

search::GenerationSeams CoordinatorNode::seams() {
  search::GenerationSeams seams;
  seams.solve = [this](std::span<const reverse::ReverseJob> jobs) {
    return reverse_.answers(jobs);
  };
  seams.replay = [this](std::span<const search::ReplayJob> jobs) { return replay_.answers(jobs); };
  seams.store = [this](std::span<const search::Transition> rows) {
    digest_.add(rows);
    transitions_.store(rows);
  };
  seams.progress = [this](const search::Progress& progress) {
    const std::scoped_lock lock(mutex_);
    progress_ = progress;
  };
  seams.cancelled = options_.stopped;
  return seams;
}

void CoordinatorNode::serve() {
  if (options_.stopped()) stop_search();
  bus_.spin(transitions_.backlog(bus::monotonic_now()) ? kBacklogWait : kWait);
  reverse_.tick();
  replay_.tick();
  const bus::Seconds now = bus::monotonic_now();
  transitions_.tick(now);
  if (!served_ && reverse_.state().workers + replay_.state().workers > 0) {
    program::say("works");
    served_ = true;
  }
  if (progress_ticker_.due(now)) publish_progress();
  if (status_.due(now)) publish_status();
}

void CoordinatorNode::stop_search() {
  reverse_.stop();
  replay_.stop();
}

void CoordinatorNode::publish_progress() {
  std::unique_lock lock(mutex_);
  const search::Progress progress = progress_;
  lock.unlock();
  const TransitionPublisher::State stream = transitions_.state();
  const PoolState reverse = reverse_.state();
  rtg_msgs::search_progress_t message{};
  message.config = options_.config;
  message.phase = progress.phase;
  message.layer = progress.layer;
  message.depth = progress.depth;
  message.transitions = stream.rows;
  message.target = options_.target;
  message.contact_share = progress.contact_share;
  message.starts_reached = progress.starts_reached;
  message.workers = reverse.workers;
  message.jobs_open = static_cast<std::int32_t>(reverse.open);
  message.consumers = stream.consumers;
  message.slowest_cursor = stream.slowest_cursor;
  message.leaving = leaving_;
  bus_.publish("RTG_PROGRESS", std::move(message));
}

void CoordinatorNode::publish_status() {
  const PoolState reverse = reverse_.state(), replay = replay_.state();
  const TransitionPublisher::State stream = transitions_.state();
  status_.publish(stream.sealed ? "sealed" : "generating", stream.rows,
                  {{"units.resent", reverse.resent + replay.resent},
                   {"units.reissued", reverse.reissued + replay.reissued},
                   {"units.given_up", reverse.given_up + replay.given_up},
                   {"stream.resent", stream.resent}});
}

}  // namespace rtg::beam_coordinator
