// rtg_beam_coordinator CONFIG.yaml KEY FOLDER [CONSUMERS]
//
// Generates the transitions of the run whose key file is KEY with the workers and the server on the
// bus. Writes FOLDER/generation.json, and before that the answers of workers and server as they
// come to FOLDER/generation.journal, from where it takes them when it is started again. Ends when
// all living consumers of the transition stream, and at least CONSUMERS (default 1), have all of
// it. CONFIG.yaml is the resolved configuration of the run. Exit status 1 if the search fell short,
// as the last lines say, 3 if the transitions are complete but units of work were skipped.

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "core/world/pace.hpp"
#include "nodes/beam_coordinator/coordinator_node.hpp"
#include "nodes/config/config.hpp"
#include "nodes/files/atomic_file.hpp"
#include "nodes/files/sealed_json.hpp"
#include "nodes/program/program.hpp"
#include "nodes/program/shutdown.hpp"

namespace rtg::beam_coordinator {
namespace {

int run(const program::Words& words) {
  const int consumers = words.size() > 3 ? program::parse_number(words[3], "CONSUMERS") : 1;
  if (!std::filesystem::is_directory(words[2]))
    throw std::invalid_argument(words[2] + ": no such folder; legal: a folder that exists");
  const config::Config config = config::load_config(words[0]);
  jobs::UnitJournal journal(std::filesystem::path(words[2]) / "generation.journal",
                            generation_hash(config));
  bus::Bus bus(config.run.bus, bus::RunKey::read(words[1]));
  CoordinatorNode node(
      bus, {program::shape_of(config.task), config_hash(config), config.search.transitions,
            [] { return program::stop_signal() != 0; }, &journal});
  if (journal.size() > 0)
    program::say("has the answers to " + std::to_string(journal.size()) + " units of work");
  program::say_waiting(bus, "the workers and the server");
  auto report = node.run([&](search::GenerationSeams seams) {
    seams.paces = paces(config.task.scene, config.physics);
    const auto seed = static_cast<std::uint64_t>(config.run.seed);
    return generate(config.task, config.search, seed, seams);
  });
  if (report) {
    report->units_from_journal = journal.units_found();
    report->journal_bytes_dropped = journal.dropped_bytes();
    files::write_atomically(std::filesystem::path(words[2]) / "generation.json",
                            files::sealed_json(to_json(*report)));
    program::say("has found " + std::to_string(report->coverage.transitions) +
                 " transitions, waits until all consumers have them");
    node.drain(consumers);
  }
  program::say("ends");
  if (!report || program::stop_signal()) return 128 + program::stop_signal();
  if (report->units_given_up > 0)
    std::fprintf(
        stderr,
        "rtg_beam_coordinator: %ld units of work were skipped, because each of them killed "
        "or stalled several workers\n",
        report->units_given_up);
  for (const std::string& shortfall : report->shortfalls)
    std::fprintf(stderr, "rtg_beam_coordinator: %s\n", shortfall.c_str());
  if (!report->shortfalls.empty()) return 1;
  return report->units_given_up > 0 ? 3 : 0;
}

}  // namespace
}  // namespace rtg::beam_coordinator

int main(int argc, char** argv) {
  return rtg::program::run(argc, argv, "CONFIG.yaml KEY FOLDER [CONSUMERS]",
                           rtg::beam_coordinator::run);
}
