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
  std::vector<TreeStart> starts = {};  // by tree
  std::vector<ReportNode> nodes = {};  // of all trees
  DataSet data{task, config, seed, seams.store};
  int shard = 0;     // that is being searched
  int attempts = 0;  // of the shards before

  /// Begins the k-th of the shards: what it finds does not depend on the others.
  void begin_shard(int k) {
    shard = config.shard + k;
    data.begin_shard(share_of_shard(config, k));
  }

  /// Returns the random number generator of attempt `number` of the shard. Training starts never
  /// use its numbers.
  Rng attempt_rng(int number) const {
    const auto first = static_cast<std::uint64_t>(shard) << 32;
    return Rng(Rng(seed).word(), first + static_cast<std::uint64_t>(number));
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

  /// Calls attempt(0), attempt(n), ... of each shard, where n is the number of attempts made so
  /// far: trees, forward searches, or waves of walks. Each call returns how many it has made. A
  /// shard ends when it has its transitions, the run is cancelled, or eight attempts in a row store
  /// nothing.
  template <class Attempt>
  void repeat(Attempt attempt) {
    for (int k = 0; k < config.shards; ++k) {
      begin_shard(k);
      int number = 0;
      for (int barren = 0; barren < 8 && !data.full() && !cancelled();) {
        const long before = data.stored();
        const int made = attempt(number);
        number += made;
        barren = data.stored() > before ? 0 : barren + made;
      }
      attempts += number;
    }
  }

  /// Reports to the progress display that layer `layer` of `last` is done in phase `phase`.
  void show(const std::string& phase, int layer, int last) const {
    if (!seams.progress) return;
    const Coverage::Figures c = data.coverage().figures();
    seams.progress({phase, layer, last, c.transitions, config.transitions, c.contact_share,
                    starts_reached(starts)});
  }
};

}  // namespace rtg::search
