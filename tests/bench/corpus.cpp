#include "tests/bench/corpus.hpp"

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "core/reverse/pruning.hpp"
#include "core/world/separation.hpp"
#include "nodes/config/config.hpp"

namespace rtg::bench {
namespace {

constexpr double kCorner = 0.2;  // between two vertices that meet [m]

bool vertices_meet(const Body& a, const Pose& at, const Body& b, const Pose& bt) {
  for (const Vector2d& v : a.shape.parts()[0].core.vertices)
    for (const Vector2d& w : b.shape.parts()[0].core.vertices)
      if ((to_world(at, v) - to_world(bt, w)).norm() < kCorner) return true;
  return false;
}

Problem read_problem(const std::string& line, const std::map<std::string, tasks::Task>& tasks) {
  std::istringstream words(line);
  Problem problem;
  std::string difficulty;
  words >> problem.task >> difficulty >> problem.job.action;
  const auto task = tasks.find(problem.task);
  const auto kind = std::ranges::find(kDifficulties, difficulty);
  if (!words || task == tasks.end() || kind == kDifficulties.end())
    throw std::runtime_error("legal: TASK DIFFICULTY ACTION x y θ ...");
  problem.difficulty = static_cast<Difficulty>(kind - kDifficulties.begin());
  const int headings = task->second.push.headings;
  if (problem.job.action < 0 || problem.job.action >= headings)
    throw std::runtime_error("legal are actions from 0 to " + std::to_string(headings - 1));
  problem.job.end.resize(task->second.scene.size());
  for (Pose& p : problem.job.end) words >> p.x >> p.y >> p.theta;
  if (!words || !(words >> std::ws).eof())
    throw std::runtime_error("legal are the poses of " + std::to_string(problem.job.end.size()) +
                             " bodies");
  return problem;
}

}  // namespace

Selection part_of(const tasks::Task& task, const PhysicsConfig& physics,
                  const reverse::ReverseJob& job) {
  const double range = physics.range + physics.skin;
  return select(task.scene, job.end, relevant_bodies(task.scene, task.push, job, range));
}

Difficulty difficulty_of(const tasks::Task& task, const PhysicsConfig& physics,
                         const reverse::ReverseJob& job) {
  const double range = physics.range + physics.skin;
  const Selection part = part_of(task, physics, job);
  const std::vector<Body>& bodies = part.scene.bodies;
  if (bodies.size() == 1) return Difficulty::kFree;
  int touching = 0;
  bool corner = false, wall = false;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double gap = separation(bodies[i].shape, part.poses[i], bodies[j].shape, part.poses[j]);
      if (gap >= range || bodies[j].fixed || jointed(part.scene, i, j)) continue;
      ++touching;
      corner |= vertices_meet(bodies[i], part.poses[i], bodies[j], part.poses[j]);
      wall |= bodies[i].fixed;
    }
  if (wall || touching >= 3) return Difficulty::kJam;
  if (corner) return Difficulty::kCorner;
  return bodies.size() == 2 ? Difficulty::kSingle : Difficulty::kMulti;
}

std::map<std::string, tasks::Task> read_tasks(const std::filesystem::path& folder) {
  std::map<std::string, tasks::Task> tasks;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    tasks::Task task = config::load_config(entry.path()).task;
    const std::string name = task.name;
    tasks.emplace(name, std::move(task));
  }
  if (tasks.empty()) throw std::runtime_error(folder.string() + ": holds no TASK.yaml");
  return tasks;
}

Corpus read_corpus(const std::filesystem::path& folder) {
  Corpus corpus{read_tasks(folder), {}};
  const std::filesystem::path file = folder / "problems.txt";
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    try {
      corpus.problems.push_back(read_problem(line, corpus.tasks));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  if (corpus.problems.empty()) throw std::runtime_error(file.string() + ": holds no problem");
  return corpus;
}

void write_problems(const std::filesystem::path& file, const std::vector<Problem>& problems) {
  std::ofstream out(file);
  out << std::setprecision(9);  // poses are single precision
  for (const Problem& problem : problems) {
    out << problem.task << ' ' << kDifficulties[static_cast<std::size_t>(problem.difficulty)] << ' '
        << problem.job.action;
    for (const Pose& p : problem.job.end) out << ' ' << p.x << ' ' << p.y << ' ' << p.theta;
    out << '\n';
  }
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace rtg::bench
