#pragma once

#include <functional>
#include <utility>

#include "core/search/generate.hpp"
#include "core/search/simulators.hpp"
#include "nodes/beam_coordinator/row_digest.hpp"
#include "nodes/config/config.hpp"

namespace rtg::testing {

/// Generates the transitions of a configuration in this process. The report has their digest.
inline search::GenerationReport generated(
    const config::Config& config, std::uint64_t seed, int threads,
    std::function<void(const search::Progress&)> progress = [](const search::Progress&) {}) {
  search::GenerationSeams seams = search::in_process_seams(
      config.task, config.physics, config.reverse, config.search.generator, threads,
      replay_on_threads(search::forward_replay(config.task, config.physics, config.forward),
                        threads));
  beam_coordinator::RowDigest digest;
  seams.store = [&digest](std::span<const search::Transition> rows) { digest.add(rows); };
  seams.progress = std::move(progress);
  search::GenerationReport report = generate(config.task, config.search, seed, seams);
  report.rows_sha256 = digest.hex();
  return report;
}

}  // namespace rtg::testing
