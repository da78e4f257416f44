#pragma once

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "nodes/jobs/worker_node.hpp"
#include "nodes/program/program.hpp"
#include "nodes/program/shutdown.hpp"

namespace rtg::program {

/// Runs `node` until the coordinator of its run leaves or a signal arrives. Returns the exit status
/// of the process. If the node is stuck with a unit, ends the process at once with status 1. Throws
/// std::runtime_error if the coordinator falls silent. Rethrows exceptions of the node.
template <class Service>
int serve(bus::Bus& bus, jobs::WorkerNode<Service>& node) {
  int status = 0;
  bool served = false;
  say_waiting(bus, "the coordinator");
  while (!stop_signal() && !node.coordinator().leaving()) {
    bus.spin(std::chrono::milliseconds(20));
    node.tick(bus::monotonic_now());
    if (!served && node.has_work()) {
      say("works");
      served = true;
    }
    if (node.stuck(bus::monotonic_now())) {
      std::fputs("stuck: a unit of work takes longer than any should; leaving it\n", stderr);
      std::_Exit(1);  // its thread cannot be joined
    }
    if (node.coordinator().silent(bus::monotonic_now())) {
      set_shutdown_deadline(1);  // the node's destructor waits for its units, which may hang
      throw std::runtime_error("no coordinator heard for two minutes");
    }
  }
  say("ends after " + std::to_string(node.units_done()) + " units of work");
  if (stop_signal()) status = 128 + stop_signal();
  set_shutdown_deadline(status);
  return status;
}

}  // namespace rtg::program
