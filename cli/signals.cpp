#include "cli/signals.h"

#include <atomic>
#include <csignal>

namespace batten::cli {

namespace {

std::atomic<bool> asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

}  // namespace

void handle_signals() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  struct sigaction stop {};
  stop.sa_handler = [](int /*signal*/) { asked = true; };
  // Without SA_RESTART a signal also ends a wait for a pipe; SA_RESETHAND gives the second signal its default effect.
  stop.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    // What nohup and shells let a process ignore stays ignored.
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(signal, &stop, nullptr);
  }
}

bool stop_asked() { return asked; }

}  // namespace batten::cli
