// Collects reverse problems of real searches: corpus_dump FOLDER [TRANSITIONS]
//
// Generates so many transitions (20000) for each FOLDER/TASK.yaml and writes FOLDER/problems.txt:
// of the candidates that pruning lets through, a fixed number of each difficulty, drawn evenly. Of
// tasks with joints only candidates in which a jointed body takes part.

#include <cstdio>
#include <exception>
#include <map>

#include "core/reverse/pruning.hpp"
#include "core/search/generate.hpp"
#include "core/search/simulators.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/bench/corpus.hpp"

namespace rtg::bench {
namespace {

// Of each task, by difficulty; where a task has fewer, so has the corpus.
constexpr std::array<std::size_t, 5> kQuota{50, 140, 140, 120, 120};

/// Keeps those problems of each difficulty whose keys are least: an even draw that does not depend
/// on the order in which threads hand them in.
class Sample {
 public:
  explicit Sample(const tasks::Task& task) : task_(task) {}

  void add(const reverse::ReverseJob& job) {
    if (is_pruned(task_.scene, task_.push, job)) return;
    if (!task_.scene.joints.empty() && part_of(task_, {}, job).scene.joints.empty()) return;
    const Difficulty difficulty = difficulty_of(task_, {}, job);
    const auto kind = static_cast<std::size_t>(difficulty);
    ++seen_[kind];
    auto& kept = kept_[kind];
    kept.emplace(key_of(job), Problem{task_.name, difficulty, job});
    if (kept.size() > kQuota[kind]) kept.erase(std::prev(kept.end()));
  }

  void move_to(std::vector<Problem>& problems) {
    for (std::size_t kind = 0; kind < kept_.size(); ++kind) {
      std::printf("%-16s %-7s %6ld seen, %3zu kept\n", task_.name.c_str(),
                  kDifficulties[kind].data(), seen_[kind], kept_[kind].size());
      for (auto& [key, problem] : kept_[kind]) problems.push_back(std::move(problem));
    }
  }

 private:
  const tasks::Task& task_;
  std::array<std::map<std::uint64_t, Problem>, kQuota.size()> kept_;
  std::array<long, kQuota.size()> seen_{};
};

void dump(const std::filesystem::path& folder, int transitions) {
  std::vector<Problem> problems;
  for (const auto& [name, task] : read_tasks(folder)) {
    search::SearchConfig search;
    search.transitions = transitions;
    Sample sample(task);
    search::GenerationSeams seams = search::in_process_seams(
        task, {}, {}, search.generator, 2, replay_on_threads(search::forward_replay(task, {}), 2));
    seams.solve = [&sample, solve = seams.solve](std::span<const reverse::ReverseJob> jobs) {
      for (const reverse::ReverseJob& job : jobs) sample.add(job);
      return solve(jobs);
    };
    seams.store = [](std::span<const search::Transition>) {};
    generate(task, search, 1, seams);
    sample.move_to(problems);
  }
  write_problems(folder / "problems.txt", problems);
}

}  // namespace
}  // namespace rtg::bench

int main(int argc, char** argv) {
  int transitions = 20000;
  if (argc < 2 || argc > 3 ||
      (argc > 2 && !rtg::bench::read_number(argv[2], 1, 10'000'000, transitions))) {
    std::fprintf(stderr, "legal: corpus_dump FOLDER [TRANSITIONS]\n");
    return 2;
  }
  try {
    rtg::bench::dump(argv[1], transitions);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "corpus_dump: %s\n", error.what());
    return 2;
  }
}
