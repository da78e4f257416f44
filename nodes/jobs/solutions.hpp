#pragma once

#include <rtg_msgs/reverse_result_t.hpp>
#include <span>

#include "core/reverse/problem/reverse_job.hpp"

namespace rtg::jobs {

/// Writes the solutions of `results` to `message`, whose other arrays are complete. Leaves them all
/// out if the message would not fit into one datagram.
void write_solutions(std::span<const reverse::ReverseResult> results,
                     rtg_msgs::reverse_result_t& message);

/// Reads the solutions of `message` into `results`, one per candidate. Returns false if counts,
/// bodies or sub-steps make no sense.
bool read_solutions(const rtg_msgs::reverse_result_t& message, int bodies,
                    std::span<reverse::ReverseResult> results);

}  // namespace rtg::jobs
