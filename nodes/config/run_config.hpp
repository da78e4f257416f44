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
    v.choice("method", method, kMethods, "values of search and train that are not given");
    v.integer("seed", seed, 0, 2147483647, "decides everything random");
    v.integer("workers", workers, 0, 1024, "reverse workers; 0: one per core");
    v.flag("in_process", in_process, "everything in one process, no LCM");
    v.flag("record", record, "lcm-logger writes all messages to lcm.log in the run folder");
    v.text("bus", bus, "LCM URL, udpm://GROUP:PORT?ttl=N");
  }
};

}  // namespace rtg::config
