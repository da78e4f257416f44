#pragma once

namespace rtg::threads {

/// Returns the CPU time that the calling thread has used so far [s].
double thread_cpu_s();

/// Returns the CPU time that all threads of the process have used so far [s]. Includes threads that
/// have ended.
double process_cpu_s();

}  // namespace rtg::threads
