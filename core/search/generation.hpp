#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/search/data_set.hpp"
#include "core/search/generate.hpp"

namespace rtg {

/// One call of generate(): what all generators work with.
struct Generation {
  const Task& task;
  const SearchConfig& config;
  std::uint64_t seed;
  const GenerationSeams& seams;
  SearchStats stats = {};
  std::vector<ReportNode> nodes = {};  // of trees
  ReplayBatch replay = counted(seams.replay, stats);
  DataSet data{task, config, seed, seams.store};

  /// Random numbers of attempt `number`, none of which a training start has.
  Rng stream(int number) const { return Rng(Rng(seed).word(), static_cast<std::uint64_t>(number)); }

  /// How far objects are moved in the starts that trees grow to and others begin at [m].
  double start_jitter() const {
    return config.randomise ? std::max(task.randomisation, task.start_jitter) : task.start_jitter;
  }

  bool cancelled() const { return seams.cancelled && seams.cancelled(); }

  /// Calls attempt(0), attempt(1), ... until the data set is full, nobody wants it any more, or
  /// eight attempts in a row have stored nothing.
  void repeat(const std::function<void(int)>& attempt);

  /// One line for the display: `layer` of `depth` of what `phase` names.
  void show(std::string phase, int layer, int depth) const;
};

}  // namespace rtg
