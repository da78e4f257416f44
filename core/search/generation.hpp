#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/search/data_set.hpp"
#include "core/search/report.hpp"
#include "core/search/seams.hpp"
#include "core/search/search_config.hpp"

namespace rtg::search {

/// A call of generate(): what all generators work with.
struct Generation {
  const tasks::Task& task;
  const SearchConfig& config;
  std::uint64_t seed;
  const GenerationSeams& seams;
  SearchStats stats = {};
  std::vector<ReportNode> nodes = {};  // of trees
  ReplayBatch replay = counted(seams.replay, stats);
  DataSet data{task, config, seed, seams.store};

  /// Random numbers of attempt `number`, none of which a training start has.
  Rng stream(int number) const { return Rng(Rng(seed).word(), static_cast<std::uint64_t>(number)); }

  /// A start that a tree grows to, or that another search or walk begins at: objects are moved by
  /// up to ± task.start_jitter, with config.randomise ± task.randomisation at least.
  Poses draw_start(Rng& rng) const {
    const double least = config.randomise ? task.randomisation : 0.0;
    return jittered_start(task, std::max(least, task.start_jitter), rng);
  }

  bool cancelled() const { return seams.cancelled && seams.cancelled(); }

  /// Calls attempt(0), attempt(1), ... until the data set is full, nobody wants it any more, or
  /// eight attempts in a row have stored nothing.
  void repeat(const std::function<void(int)>& attempt);

  /// A line for the display: `layer` of `depth` of what `phase` names.
  void show(std::string phase, int layer, int depth) const;
};

}  // namespace rtg::search
