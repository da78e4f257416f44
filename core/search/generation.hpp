#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/search/data_set.hpp"
#include "core/search/report.hpp"
#include "core/search/seams.hpp"
#include "core/search/search_config.hpp"

namespace rtg::search {

/// State of one call of generate(), shared by the generators.
struct Generation {
  const tasks::Task& task;
  const SearchConfig& config;
  std::uint64_t seed;
  const GenerationSeams& seams;
  SearchStats stats = {};
  std::vector<ReportNode> nodes = {};  // of all trees
  DataSet data{task, config, seed, seams.store};

  /// Returns the random number generator of attempt `number`. Training starts never use its
  /// numbers.
  Rng attempt_rng(int number) const {
    return Rng(Rng(seed).word(), static_cast<std::uint64_t>(number));
  }

  /// Draws a random start state. Each object moves by up to ± task.start_jitter in x and y. With
  /// config.randomise the limit is task.randomisation, if that is larger.
  Poses draw_start(Rng& rng) const {
    const double least = config.randomise ? task.randomisation : 0.0;
    return jittered_start(task, std::max(least, task.start_jitter), rng);
  }

  /// Returns the largest number of layers of a search. More actions have no place in an episode.
  int layers() const { return std::min(config.depth, task.horizon); }

  ReplayBatch replay(Stage stage) { return counted(seams.replay, stats, stage); }

  bool cancelled() const { return seams.cancelled && seams.cancelled(); }

  /// Calls attempt(0), attempt(1), ...: each runs one tree, forward search or wave of walks. Ends
  /// when the data set is full, the run is cancelled, or eight attempts in a row store nothing.
  template <class Attempt>
  void repeat(Attempt attempt) {
    for (int number = 0, barren = 0; barren < 8 && !data.full() && !cancelled(); ++number) {
      const long before = data.coverage().transitions();
      attempt(number);
      barren = data.coverage().transitions() > before ? 0 : barren + 1;
    }
  }

  /// Reports to the progress display that layer `layer` of `last` is done in phase `phase`.
  void show(const std::string& phase, int layer, int last) const {
    if (!seams.progress) return;
    const Coverage::Figures c = data.coverage().figures();
    seams.progress({phase, layer, last, c.transitions, config.transitions, c.contact_share,
                    c.start_region_transitions});
  }
};

}  // namespace rtg::search
