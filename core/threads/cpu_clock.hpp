#pragma once

namespace rtg::threads {

/// CPU time the calling thread has used so far [s].
double thread_cpu_s();

/// The same of all threads of the process, those that have ended, too [s].
double process_cpu_s();

}  // namespace rtg::threads
