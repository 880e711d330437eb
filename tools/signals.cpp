#include "signals.h"

#include <signal.h>
#include <unistd.h>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "exit_codes.h"

namespace delvox::tools {
namespace {

std::atomic<bool> g_cancel{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_stop_signal(int) {
  if (!g_cancel.exchange(true)) return;
  remove_unfinished_outputs();
  ::_exit(kExitCancelled);
}

}  // namespace

void install_signal_handlers() {
  struct sigaction action {};
  action.sa_handler = on_stop_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction previous {};
    sigaction(signal_number, nullptr, &previous);
    // nohup and background jobs of a shell ignore signals on purpose: leave those alone.
    if (previous.sa_handler != SIG_IGN) sigaction(signal_number, &action, nullptr);
  }
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);
}

const std::atomic<bool>& cancel_requested() { return g_cancel; }

void throw_if_cancelled() {
  if (g_cancel) throw Cancelled();
}

}  // namespace delvox::tools
