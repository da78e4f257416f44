#include "nodes/bus/node_status.hpp"

#include <rtg_msgs/node_status_t.hpp>
#include <rtg_msgs/search_progress_t.hpp>

#include "core/threads/cpu_clock.hpp"

namespace rtg::bus {

void NodeStatus::publish(const std::string& state, std::int64_t done,
                         const std::map<std::string, long>& counts) {
  rtg_msgs::node_status_t message{};
  message.node = node_;
  message.number = number_;
  message.state = state;
  message.done = done;
  message.cpu_s = threads::process_cpu_s();
  std::map<std::string, long> all = bus_.counters().all();
  all.insert(counts.begin(), counts.end());
  for (const auto& [name, value] : all) {
    message.counter_name.push_back(name);
    message.counter_value.push_back(value);
  }
  message.n = static_cast<std::int32_t>(all.size());
  bus_.publish("RTG_STATUS", message);
}

CoordinatorWatch::CoordinatorWatch(Bus& bus) {
  bus.subscribe<rtg_msgs::search_progress_t>("RTG_PROGRESS",
                                             [this](const rtg_msgs::search_progress_t& progress) {
                                               heard_ = monotonic_now();
                                               leaving_ = progress.leaving != 0;
                                             });
}

}  // namespace rtg::bus
