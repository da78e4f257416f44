// Solves reverse problems and writes each with our solution, a line of JSON per problem:
//
//   peer_dump corpus FOLDER N                      each N-th committed problem in which bodies may
//                                                  touch
//   peer_dump pushes CONFIG.yaml COUNT PRESET      after COUNT pushes of Box2D, see true_pushes
//
// A line holds all that defines the problem (shapes, configurations, final state, direction), the
// start of the SQP, our solution, and our own values of objective and constraints there. For
// peer.py, which builds the same problem with CasADi and solves it with IPOPT. All problems of a
// task with the same numbers of bodies are solved together, as a search does; "cpu_s" is a
// problem's share of that time, starts and all, by its number of iterations and one.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/reverse/candidate.hpp"
#include "core/reverse/problem/reverse_model.hpp"
#include "core/reverse/problem/warm_start.hpp"
#include "core/threads/cpu_clock.hpp"
#include "nodes/config/config.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/bench/corpus.hpp"
#include "tests/bench/true_push.hpp"

namespace rtg::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Visitor of a configuration that notes its numbers.
struct Numbers {
  Json found = Json::object();

  void number(const char* key, double field, double, double, const char*) { found[key] = field; }
  void integer(const char* key, int field, int, int, const char*) { found[key] = field; }
  void flag(const char* key, bool field, const char*) { found[key] = field; }
  template <class Enum, class Names>
  void choice(const char*, Enum, const Names&, const char*) {}
};

template <class Section>
Json numbers(Section config) {
  Numbers numbers;
  config.visit(numbers);
  return numbers.found;
}

template <class Vector>
Json rows(const std::vector<Vector>& levels) {
  Json out = Json::array();
  for (const Vector& v : levels) out.push_back(std::vector<double>(v.begin(), v.end()));
  return out;
}

Json bodies(const Scene& scene) {
  Json out = Json::array();
  for (const Body& body : scene.bodies) {
    Json vertices = Json::array();
    for (const Vector2d& v : body.shape.parts()[0].core.vertices)
      vertices.push_back({v.x(), v.y()});
    out.push_back({{"vertices", vertices},
                   {"density", body.density},
                   {"friction", body.friction},
                   {"fixed", body.fixed}});
  }
  return out;
}

Json iterate(const reverse::Iterate& x) {
  return {{"p", rows(x.p)}, {"forces", rows(x.forces)}, {"controls", rows(x.controls)}};
}

/// A problem with its number in the output.
struct Entry {
  std::size_t number = 0;
  std::string_view kind;  // its difficulty, in the corpus
  bool wanted = false;
  const tasks::Task* task = nullptr;
  reverse::ReverseJob job;
  std::unique_ptr<reverse::Candidate> candidate;
};

Json dumped(const Entry& entry, const reverse::ReverseModel& model,
            const reverse::ReverseConfig& config, const reverse::SqpResult& solved, double cpu) {
  const reverse::Candidate& candidate = *entry.candidate;
  const reverse::ReverseProblem& nlp = candidate.problem();
  const bool paper = config.preset == reverse::ReversePreset::kPaper;
  // As FilterSqp and MeritSqp start.
  const auto warm = paper ? std::nullopt : warm_start(nlp);
  const reverse::Iterate start = warm ? *warm : reverse::static_iterate(nlp);
  const reverse::Violation v = violation(nlp, solved.x);
  VectorXd state(3 * static_cast<Eigen::Index>(entry.job.end.size()));
  for (std::size_t k = 0; k < entry.job.end.size(); ++k)
    state.segment<3>(3 * static_cast<Eigen::Index>(k)) << entry.job.end[k].x, entry.job.end[k].y,
        entry.job.end[k].theta;
  return {{"number", entry.number},
          {"kind", entry.kind},
          {"bodies", bodies(candidate.scene())},
          {"physics", numbers(model.physics)},
          {"stride", longest_stride(entry.task->push)},
          {"reverse", numbers(config)},
          {"state", std::vector<double>(state.begin(), state.end())},
          {"action", entry.job.action},
          {"members", candidate.bodies()},
          {"end", std::vector<double>(nlp.end.begin(), nlp.end.end())},
          {"start_spare", nlp.energy.barrier().start_spare()},
          {"direction", {nlp.direction.x(), nlp.direction.y()}},
          {"start", iterate(start)},
          {"status", name(solved.status)},
          {"iterations", solved.iterations},
          {"cpu_s", cpu},
          {"solution", iterate(solved.x)},
          {"objective", objective(nlp, solved.x)},
          {"residuals", rows(v.residuals)},
          {"complementarity", rows(v.complementarity)}};
}

/// Solves the problems of one task and prints the wanted ones.
void dump(const tasks::Task& task, const reverse::ReverseConfig& config,
          std::vector<Entry> entries) {
  const reverse::ReverseModel model = reverse_model(task.scene, {}, config);
  std::map<std::pair<int, int>, std::vector<const Entry*>> alike;  // by the cost of an iteration
  for (Entry& entry : entries) {
    entry.task = &task;
    entry.candidate = std::make_unique<reverse::Candidate>(model.scene, model.physics, task.push,
                                                           config, entry.job);
    const energy::StepEnergy& energy = entry.candidate->problem().energy;
    alike[{energy.dofs(), energy.bodies()}].push_back(&entry);
  }
  for (const auto& [sizes, some] : alike) {
    std::vector<const reverse::Candidate*> candidates;
    for (const Entry* entry : some) candidates.push_back(entry->candidate.get());
    const double begin = threads::thread_cpu_s();
    const std::vector<reverse::SqpResult> solved = solve_together(candidates);
    const double cpu = threads::thread_cpu_s() - begin;
    const auto weight = [](const reverse::SqpResult& one) { return one.iterations + 1; };
    int all = 0;
    for (const reverse::SqpResult& one : solved) all += weight(one);
    for (std::size_t k = 0; k < some.size(); ++k)
      if (some[k]->wanted)
        std::puts(dumped(*some[k], model, config, solved[k], cpu * weight(solved[k]) / all)
                      .dump()
                      .c_str());
  }
}

void dump_corpus(const std::filesystem::path& folder, std::size_t every) {
  const Corpus corpus = read_corpus(folder);
  std::map<std::string, std::vector<Entry>> entries;
  std::size_t met = 0;
  for (std::size_t k = 0; k < corpus.problems.size(); ++k) {
    const auto& [task, difficulty, job] = corpus.problems[k];
    if (difficulty == Difficulty::kFree) continue;
    const std::string_view kind = kDifficulties[static_cast<std::size_t>(difficulty)];
    entries[task].push_back({k + 1, kind, met++ % every == 0, nullptr, job, nullptr});
  }
  for (auto& [task, of_it] : entries) dump(corpus.tasks.at(task), {}, std::move(of_it));
}

void dump_pushes(const std::filesystem::path& file, std::size_t count,
                 reverse::ReversePreset preset) {
  const tasks::Task task = config::load_config(file).task;
  const forward::Box2dSimulator box2d(task.scene, task.push, {});
  std::vector<Entry> entries;
  for (TruePush& push : draw_pushes(task, box2d, count))
    entries.push_back({entries.size() + 1, task.name, true, nullptr, std::move(push.job), nullptr});
  dump(task, reverse_preset(preset), std::move(entries));
}

/// Returns the exit status.
int run(std::span<char* const> words) {
  std::size_t number = 0;
  const bool numbered =
      words.size() >= 3 && read_number(words[2], std::size_t{1}, std::size_t{100000}, number);
  const std::string_view what = words.empty() ? "" : words[0];
  if (what == "corpus" && words.size() == 3 && numbered) {
    dump_corpus(words[1], number);
    return 0;
  }
  const auto preset = std::ranges::find(reverse::kReversePresets,
                                        std::string_view(words.size() == 4 ? words[3] : ""));
  if (what == "pushes" && numbered && preset != reverse::kReversePresets.end()) {
    dump_pushes(words[1], number,
                static_cast<reverse::ReversePreset>(preset - reverse::kReversePresets.begin()));
    return 0;
  }
  std::fprintf(stderr, "legal: peer_dump corpus FOLDER N, peer_dump pushes CONFIG COUNT PRESET\n");
  return 2;
}

}  // namespace
}  // namespace rtg::bench

int main(int argc, char** argv) {
  try {
    return rtg::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "peer_dump: %s\n", error.what());
    return 2;
  }
}
