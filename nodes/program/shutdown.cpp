#include "nodes/program/shutdown.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace rtg::program {
namespace {

constexpr unsigned kGrace = 4;  // [s]; the process must have ended after 5 s

std::atomic<int> first_signal{0};
std::atomic<int> late_status{0};
static_assert(std::atomic<int>::is_always_lock_free);  // so signal handlers may use it

void on_stop_signal(int number) {
  if (first_signal.exchange(number) != 0) _exit(128 + number);
  late_status = 128 + number;
  alarm(kGrace);
}

void on_alarm(int) { _exit(late_status); }

void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigaction(number, &action, nullptr);
}

}  // namespace

void watch_signals() {
  handle(SIGALRM, on_alarm);
  handle(SIGXFSZ, SIG_IGN);  // write() then says that the file has become too long
  for (const int number : {SIGINT, SIGTERM}) handle(number, on_stop_signal);
}

int stop_signal() { return first_signal; }

void set_shutdown_deadline(int status) {
  late_status = status;
  alarm(kGrace);
}

}  // namespace rtg::program
