#include "core/search/generate.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>

#include "core/search/coverage.hpp"
#include "core/search/exploration.hpp"
#include "core/search/lost_state.hpp"
#include "core/search/plan_search.hpp"
#include "core/search/policy_learning.hpp"
#include "core/search/random_episodes.hpp"
#include "core/search/roll_out.hpp"

namespace rtg {
namespace {

// Keys of the independent random streams of one run.
enum Stream : std::uint64_t {
  kExploration = 1,
  kOthers,
  kChoice,
  kEvaluation,
  kRollOuts,
  kMending
};

constexpr int kWave = 50;                              // episodes that run in lockstep
constexpr std::array<std::size_t, 2> kMendFrom{0, 8};  // actions before a failed one is mended
constexpr int kChoices = 20;                           // waves that show which steps serve
constexpr int kMastered = 3;     // rounds that find nothing left to learn, and the search is over
constexpr double kMisses = 0.3;  // share of the draws of steps whose plan misses that count
constexpr int kMaxBarren = 8;    // rounds or waves without a transition before it gives up

std::string percent(std::size_t part, std::size_t whole) {
  return std::to_string(100 * std::min(part, whole) / std::max<std::size_t>(whole, 1)) + " %";
}

/// One run of generate().
class Generation {
 public:
  Generation(const Task& task, const SearchConfig& config, std::uint64_t seed,
             const GenerationSeams& seams)
      : task_(task),
        config_(config),
        seed_(seed),
        seams_(seams),
        coverage_(task),
        exploration_(task, config_, Rng(seed, kExploration << 32).word(), seams, stats_),
        others_(seed, kOthers << 32) {}

  GenerationReport run() {
    trees_ = std::lround(static_cast<double>(config_.transitions) * (1.0 - config_.rollout_share));
    explore();
    mend();
    if (!cancelled()) choose();
    if (!cancelled()) judge_trees();
    for (int barren = 0; stored() < config_.transitions && barren < kMaxBarren && !cancelled();)
      barren = roll_out() ? 0 : barren + 1;
    return finished_report();
  }

 private:
  long stored() const { return coverage_.transitions(); }
  bool cancelled() const { return seams_.cancelled && seams_.cancelled(); }

  /// Stores the first of them, as far as `limit` transitions in all leave room; returns these.
  std::span<const Transition> store(std::span<const Transition> transitions, long limit) {
    const auto room = static_cast<std::size_t>(std::max(0L, limit - stored()));
    const auto kept = transitions.first(std::min(room, transitions.size()));
    if (kept.empty()) return kept;
    for (const Transition& t : kept) coverage_.add(t);
    seams_.store(kept);
    return kept;
  }

  /// Puts what is left to be taken of a step and its plan into `batch`.
  void take(StepPool::Index step, std::vector<Transition>& batch) {
    const auto room = trees_ - stored() - static_cast<long>(batch.size());
    for (Transition& t : exploration_.pool().take(step, static_cast<std::size_t>(room)))
      batch.push_back(std::move(t));
  }

  /// Rounds of trees until `explored` steps per stored one are found, or there is nothing to learn.
  void explore() {
    const auto limit = static_cast<std::size_t>(static_cast<double>(trees_) * config_.explored);
    const auto after_layer = [this, limit](int layer, std::size_t first) {
      store_some(first);
      report_progress("round " + std::to_string(exploration_.rounds() + 1) + " (" +
                          percent(exploration_.pool().size(), limit) + ")",
                      layer, config_.depth);
    };
    for (int barren = 0; exploration_.pool().size() < limit && barren < kMaxBarren &&
                         exploration_.mastered() < kMastered && !cancelled();)
      barren = exploration_.round(limit, after_layer) ? 0 : barren + 1;
  }

  /// Waves of episodes of the policy until `mended` steps per stored one are found at least; it
  /// learns those that succeed and, for the others, the plans that a search forwards finds.
  void mend() {
    const StepPool& pool = exploration_.pool();
    const auto wanted = static_cast<std::size_t>(static_cast<double>(trees_) * config_.mended);
    const std::size_t explored = pool.size(), limit = explored + wanted;
    for (int wave = 0; pool.size() < limit && policy().size() > 0 && !cancelled(); ++wave) {
      const std::size_t before = pool.size();
      std::vector<Episode> tried = episodes(kMending, wave);
      if (cancelled()) break;
      mend(std::move(tried));
      report_progress("mending (" + percent(pool.size() - explored, wanted) + ")", 0, 0);
      if (pool.size() == before) break;
    }
  }

  void mend(std::vector<Episode> wave) {
    std::vector<Poses> lost;
    std::vector<std::vector<Transition>> plans;
    for (Episode& e : wave) {
      if (e.success) {
        for (Transition& t : e.steps) t.source = Source::kMended;
        plans.push_back(std::move(e.steps));
        continue;
      }
      for (const std::size_t k : kMendFrom)
        if (k < e.steps.size()) lost.push_back(e.steps[k].poses);
    }
    std::ranges::move(search_plans(task_, policy(), lost, seams_.replay, stats_),
                      std::back_inserter(plans));
    for (const auto& plan : plans) exploration_.add_plan(plan);
  }

  /// Puts a step drawn at random and its plan into `batch`; of those whose plan misses, few.
  void take_other(StepPool::Index step, std::vector<Transition>& batch) {
    if (exploration_.pool().leads(step) || others_.uniform(0.0, 1.0) < kMisses) take(step, batch);
  }

  /// Of the steps from index `first` on, some drawn at random.
  void store_some(std::size_t first) {
    const auto found = static_cast<double>(exploration_.pool().size());
    const auto fresh = static_cast<int>(exploration_.pool().size() - first);
    const double wanted =
        std::min(found / config_.explored, static_cast<double>(trees_)) * config_.others;
    std::vector<Transition> batch;
    for (int draw = 0; draw < fresh; ++draw) {
      if (static_cast<double>(stored()) + static_cast<double>(batch.size()) >= wanted) break;
      take_other(first + static_cast<std::size_t>(others_.below(fresh)), batch);
    }
    store(batch, trees_);
  }

  /// Stores what episodes of the policy use, and, if that is not enough, others drawn at random;
  /// the policy forgets the rest.
  void choose() {
    for (int wave = 0; wave < kChoices && policy().size() > 0 && stored() < trees_ && !cancelled();
         ++wave) {
      std::vector<Transition> batch;
      for (const Episode& e : episodes(kChoice, wave))
        if (e.success)
          for (const std::uint64_t key : e.used)
            if (const auto step = exploration_.pool().find(key)) take(*step, batch);
      store(batch, trees_);
      report_progress("choice", wave + 1, kChoices);
    }
    std::vector<Transition> batch;
    for (const bool any : {false, true})
      for (const StepPool::Index step : shuffled(exploration_.pool().size())) {
        if (stored() + static_cast<long>(batch.size()) >= trees_) break;
        any ? take(step, batch) : take_other(step, batch);
      }
    store(batch, trees_);
    policy().retain(exploration_.pool().taken());
  }

  std::vector<StepPool::Index> shuffled(std::size_t count) {
    std::vector<StepPool::Index> out(count);
    std::iota(out.begin(), out.end(), StepPool::Index{0});
    for (std::size_t k = count; k > 1; --k)
      std::swap(out[k - 1], out[static_cast<std::size_t>(others_.below(static_cast<int>(k)))]);
    return out;
  }

  /// A wave of them, with noise, from jittered starts.
  std::vector<Episode> episodes(Stream stream, int wave) {
    Rng rng(seed_, stream << 32 | static_cast<std::uint64_t>(wave));
    const auto starts = jittered_starts(task_, kWave, config_.rollout_jitter, rng);
    const EpisodePlan plan{starts, config_.rollout_noise, rng.word()};
    return run_episodes(task_, policy(), plan, seams_.replay, stats_);
  }

  /// How the policy of the trees does before it learns from roll-outs of its own.
  void judge_trees() {
    Rng rng(seed_, kEvaluation << 32);
    const double amplitude = config_.randomise ? task_.randomisation : task_.start_jitter;
    std::vector<Poses> starts;
    for (int k = 0; k < config_.evaluation_starts; ++k)
      starts.push_back(jittered_start(task_, amplitude, rng));
    const PolicyScore score = evaluate_policy(task_, policy(), starts, seams_.replay, stats_);
    report_.tree_policy_success = score.success;
    report_.tree_policy_length_mean = score.length_mean;
  }

  bool roll_out() {
    const long before = stored();
    for (const Episode& e : episodes(kRollOuts, wave_count_))
      learn_episode(policy(), store(worth_keeping(e), config_.transitions));
    report_progress("roll-outs", ++wave_count_, 0);
    return stored() > before;
  }

  TreePolicy& policy() { return exploration_.policy(); }

  void report_progress(std::string phase, int layer, int depth) const {
    if (!seams_.progress) return;
    seams_.progress({std::move(phase), layer, depth, stored(), config_.transitions,
                     coverage_.contact_share(), coverage_.start_region()});
  }

  GenerationReport finished_report() {
    report_.explored = static_cast<long>(exploration_.pool().size());
    report_.start_region_depth = exploration_.start_region_depth();
    report_.nodes = exploration_.nodes();
    fill(report_, coverage_);
    fill(report_, stats_);
    return std::move(report_);
  }

  const Task& task_;
  SearchConfig config_;
  std::uint64_t seed_;
  const GenerationSeams& seams_;
  Coverage coverage_;
  SearchStats stats_;
  Exploration exploration_;
  Rng others_;
  GenerationReport report_;
  long trees_ = 0;  // transitions of trees and mended episodes to be stored
  int wave_count_ = 0;
};

/// With `randomise`, starts lie all over the task's randomisation.
SearchConfig randomised(SearchConfig config, const Task& task) {
  if (config.randomise)
    for (double* jitter : {&config.target_jitter, &config.rollout_jitter})
      *jitter = std::max(*jitter, task.randomisation);
  return config;
}

}  // namespace

GenerationReport generate(const Task& task, const SearchConfig& config, std::uint64_t seed,
                          const GenerationSeams& seams) {
  const auto start = std::chrono::steady_clock::now();
  GenerationReport report = config.reverse == ReverseMode::kRandom
                                ? random_episodes(task, randomised(config, task), seed, seams)
                                : Generation(task, randomised(config, task), seed, seams).run();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  report.generate_wall_s = wall.count();
  return report;
}

}  // namespace rtg
