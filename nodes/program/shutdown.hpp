#pragma once

namespace rtg::program {

/// Installs the handlers of SIGINT and SIGTERM. After the first signal, stop_signal() returns its
/// number and the process ends within a few seconds. The second signal ends it at once. Must be
/// called before threads start.
void watch_signals();

/// Returns the number of the signal that asked the process to end; 0 if none has arrived.
int stop_signal();

/// Makes the process end within a few seconds with exit status `status`, whatever its threads do.
/// Needed for a shutdown without a signal.
void set_shutdown_deadline(int status);

}  // namespace rtg::program
