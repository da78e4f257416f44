#pragma once

namespace rtg::program {

/// Installs the handlers of SIGINT and SIGTERM. After the first signal stop_signal() returns its
/// number, and the process ends within a few seconds. The second signal ends the process at once.
/// Must be called before threads start.
void watch_signals();

/// Returns the number of the signal that asked the process to end; 0 if none has arrived.
int stop_signal();

/// Makes the process end with exit status `status` in a few seconds at the latest, whatever its
/// threads are doing. Needed where a shutdown begins without a signal.
void set_shutdown_deadline(int status);

}  // namespace rtg::program
