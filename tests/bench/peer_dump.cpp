// Solves every N-th committed problem in which bodies may touch and writes it with our solution:
//
//   peer_dump FOLDER N > problems.json
//
// a line of JSON per problem: all that defines it (shapes, configurations, final state, direction),
// the warm start, our solution, and our own values of objective and constraints there. For
// peer.py, which builds the same problem with CasADi and solves it with IPOPT. All problems of a
// task with the same numbers of bodies are solved together, as a search does; "cpu_s" is a
// problem's share of that time, warm starts and all, by its number of iterations and one.

#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>

#include "core/reverse/candidate.hpp"
#include "core/reverse/problem/warm_start.hpp"
#include "core/threads/cpu_clock.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/bench/corpus.hpp"

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
    for (const Vector2d& v : body.shape.vertices) vertices.push_back({v.x(), v.y()});
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

/// The configurations that all problems are solved with.
const PhysicsConfig kPhysics;
const reverse::ReverseConfig kReverse;

/// A problem with its place in the corpus.
struct Entry {
  std::size_t line = 0;
  const Problem* problem = nullptr;
  bool wanted = false;
  std::unique_ptr<reverse::Candidate> candidate;
};

/// Task and numbers of degrees of freedom and bodies: an iteration costs problems alike the same.
using Kind = std::tuple<std::string, int, int>;

Json dumped(const Entry& entry, const tasks::Task& task, const reverse::SqpResult& solved,
            double cpu) {
  const Problem& problem = *entry.problem;
  const reverse::Candidate& candidate = *entry.candidate;
  const reverse::ReverseProblem& nlp = candidate.problem();
  const auto warm = warm_start(nlp);
  const reverse::Violation v = violation(nlp, solved.x);
  return {{"line", entry.line},
          {"difficulty", kDifficulties[static_cast<std::size_t>(problem.difficulty)]},
          {"bodies", bodies(candidate.scene())},
          {"physics", numbers(kPhysics)},
          {"push", numbers(task.push)},
          {"reverse", numbers(kReverse)},
          {"end", std::vector<double>(nlp.end.begin(), nlp.end.end())},
          {"direction", {nlp.direction.x(), nlp.direction.y()}},
          {"warm", warm ? iterate(*warm) : Json()},
          {"status", name(solved.status)},
          {"iterations", solved.iterations},
          {"cpu_s", cpu},
          {"solution", iterate(solved.x)},
          {"objective", objective(nlp, solved.x)},
          {"residuals", rows(v.residuals)},
          {"complementarity", rows(v.complementarity)}};
}

std::map<Kind, std::vector<Entry>> entries(const Corpus& corpus, std::size_t every) {
  std::map<Kind, std::vector<Entry>> out;
  std::size_t met = 0;
  for (std::size_t k = 0; k < corpus.problems.size(); ++k) {
    const Problem& problem = corpus.problems[k];
    if (problem.difficulty == Difficulty::kFree) continue;
    const tasks::Task& task = corpus.tasks.at(problem.task);
    Entry entry{k + 1, &problem, met++ % every == 0,
                std::make_unique<reverse::Candidate>(task.scene, kPhysics, task.push, kReverse,
                                                     problem.job)};
    const energy::StepEnergy& energy = entry.candidate->problem().energy;
    out[{problem.task, energy.dofs(), energy.bodies()}].push_back(std::move(entry));
  }
  return out;
}

void dump(const std::filesystem::path& folder, std::size_t every) {
  const Corpus corpus = read_corpus(folder);
  for (const auto& [kind, alike] : entries(corpus, every)) {
    std::vector<const reverse::Candidate*> candidates;
    for (const Entry& entry : alike) candidates.push_back(entry.candidate.get());
    const double begin = threads::thread_cpu_s();
    const std::vector<reverse::SqpResult> solved = solve_together(candidates);
    const double cpu = threads::thread_cpu_s() - begin;
    const auto weight = [](const reverse::SqpResult& one) { return one.iterations + 1; };
    int all = 0;
    for (const reverse::SqpResult& one : solved) all += weight(one);
    for (std::size_t k = 0; k < alike.size(); ++k)
      if (alike[k].wanted)
        std::puts(dumped(alike[k], corpus.tasks.at(std::get<0>(kind)), solved[k],
                         cpu * weight(solved[k]) / all)
                      .dump()
                      .c_str());
  }
}

}  // namespace
}  // namespace rtg::bench

int main(int argc, char** argv) {
  std::size_t every = 0;
  if (argc != 3 || !rtg::bench::read_number(argv[2], std::size_t{1}, std::size_t{100000}, every)) {
    std::fprintf(stderr, "legal: peer_dump FOLDER N\n");
    return 2;
  }
  try {
    rtg::bench::dump(argv[1], every);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "peer_dump: %s\n", error.what());
    return 2;
  }
}
