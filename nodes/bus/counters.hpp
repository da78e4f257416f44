#pragma once

#include <map>
#include <mutex>
#include <string>

namespace rtg::bus {

/// Named event counters of one process, for example of dropped messages. NodeStatus publishes them.
/// Thread-safe.
class Counters {
 public:
  void add(const std::string& name, long n = 1) {
    const std::scoped_lock lock(mutex_);
    counts_[name] += n;
  }

  /// Returns 0 for a name that was never counted.
  long value(const std::string& name) const {
    const std::scoped_lock lock(mutex_);
    const auto found = counts_.find(name);
    return found == counts_.end() ? 0 : found->second;
  }

  std::map<std::string, long> all() const {
    const std::scoped_lock lock(mutex_);
    return counts_;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, long> counts_;
};

}  // namespace rtg::bus
