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

/// State of one call of generate(), on which all generators work.
struct Generation {
  const tasks::Task& task;
  const SearchConfig& config;
  std::uint64_t seed;
  const GenerationSeams& seams;
  SearchStats stats = {};
  std::vector<ReportNode> nodes = {};  // of all trees
  ReplayBatch replay = counted(seams.replay, stats);
  DataSet data{task, config, seed, seams.store};

  /// Returns the random numbers of attempt `number`. No training start uses the same ones.
  Rng stream(int number) const { return Rng(Rng(seed).word(), static_cast<std::uint64_t>(number)); }

  /// Draws a start, towards which a tree grows or from which a forward search or a walk begins.
  /// Objects are moved by up to ± task.start_jitter or, with config.randomise, by up to ± the
  /// larger of task.start_jitter and task.randomisation.
  Poses draw_start(Rng& rng) const {
    const double least = config.randomise ? task.randomisation : 0.0;
    return jittered_start(task, std::max(least, task.start_jitter), rng);
  }

  bool cancelled() const { return seams.cancelled && seams.cancelled(); }

  /// Calls attempt(0), attempt(1), ... until the data set is full, the run is cancelled, or eight
  /// attempts in a row have stored nothing.
  void repeat(const std::function<void(int)>& attempt);

  /// Sends a line to the progress display: layer `layer` of `depth` in phase `phase`.
  void show(std::string phase, int layer, int depth) const;
};

}  // namespace rtg::search
