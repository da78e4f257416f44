#pragma once

namespace rtg::program {

/// From here on SIGINT and SIGTERM end the process in an orderly way: the first one makes
/// stop_signal() tell its number, the second one ends the process at once. To be called before
/// threads start.
void watch_signals();

/// Number of the signal that asks for an end; 0 as long as there was none.
int stop_signal();

/// The process ends with `status` after a few seconds, whatever its threads are doing; for those
/// who begin to shut down without a signal.
void limit_shutdown(int status);

}  // namespace rtg::program
