#pragma once

#include <string>

#include "nodes/config/method.hpp"

namespace rtg::config {

/// Settings for the execution of a run. Of these, only `seed` and the settings of `method` affect
/// the generated transitions. Over LCM, learning also depends on when the transitions arrive.
struct RunConfig {
  Method method = Method::kDdqnRtg;
  int seed = 1;
  int workers = 0;  // reverse workers; the loader replaces 0 by the number of cores
  bool in_process = false;
  bool record = false;
  std::string bus = "udpm://239.255.76.67:7667?ttl=0";

  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("method", method, kMethods,
             "compared method: defaults of some keys of search and train");
    v.integer("seed", seed, 0, 2147483647, "seed of all random numbers");
    v.integer("workers", workers, 0, 1024, "number of reverse workers; 0: one per core");
    v.flag("in_process", in_process, "run everything in one process, without LCM");
    v.flag("record", record, "record all messages with lcm-logger, in lcm.log of the run folder");
    v.text("bus", bus, "LCM URL of the message bus, udpm://GROUP:PORT?ttl=N");
  }
};

}  // namespace rtg::config
