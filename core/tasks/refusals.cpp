#include "core/tasks/refusals.hpp"

#include <algorithm>

namespace rtg::tasks {
namespace {

std::string words(const Refusal& refusal, const Scene& scene) {
  const auto name = [&](std::size_t i) { return '\'' + scene.bodies[i].name + '\''; };
  switch (refusal.kind) {
    case Refusal::Kind::kTerm:
      return "task.goal." + std::to_string(refusal.a) + " did not hold";
    case Refusal::Kind::kNoRoom:
      return refusal.a == refusal.b
                 ? name(refusal.a) + " was out of the arena"
                 : name(refusal.a) + " was nearer to " + name(refusal.b) + " than the clearance";
    case Refusal::Kind::kNoRobot:
      return "the robot found no place";
    case Refusal::Kind::kSolved:
      return "the goal held";
  }
  return "";
}

}  // namespace

long Refusals::most() const {
  long most = 0;
  for (const auto& [refusal, count] : counts_) most = std::max(most, count);
  return most;
}

void Refusals::count_main(const Refusals& proposals) {
  ++tries_;
  const long most = proposals.most();
  for (const auto& [refusal, count] : proposals.counts_)
    if (count == most) ++counts_[refusal];
}

std::optional<Refusals::Main> Refusals::main() const {
  const auto found = std::ranges::find(counts_, most(), [](const auto& c) { return c.second; });
  if (found == counts_.end()) return std::nullopt;
  return Main{found->first, static_cast<double>(found->second) / static_cast<double>(tries_)};
}

std::optional<std::size_t> main_term(const Refusals& refusals) {
  const auto main = refusals.main();
  if (!main || main->refusal.kind != Refusal::Kind::kTerm || main->share < 0.5) return std::nullopt;
  return main->refusal.a;
}

std::string main_reason(const Refusals& refusals, const Scene& scene) {
  const auto main = refusals.main();
  if (!main) return "no try failed";
  const int percent = static_cast<int>(100.0 * main->share);
  return words(main->refusal, scene) + " in " + std::to_string(percent) + "% of the failed tries";
}

}  // namespace rtg::tasks
