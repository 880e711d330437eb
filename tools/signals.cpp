#include "signals.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <initializer_list>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "exit_codes.h"

namespace delvox::tools {
namespace {

constexpr std::initializer_list<int> kStopSignals = {SIGINT, SIGTERM, SIGHUP};

std::atomic<bool> g_cancel{false};
std::atomic<int> g_signal{0}, g_sender{0};  // of the first signal, for the message
std::atomic<std::int64_t> g_asked_at{0};    // in milliseconds
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

std::int64_t milliseconds() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);  // unlike std::chrono, promised to be safe in a signal handler
  return std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1000000;
}

void on_stop_signal(int number, siginfo_t* info, void*) {
  // timeout(1) and shells signal a process and then its group: what comes within a moment is the same request.
  constexpr std::int64_t kMoment = 300;
  if (g_cancel) {
    if (milliseconds() - g_asked_at < kMoment) return;
    remove_unfinished_outputs();
    ::_exit(kExitCancelled);
  }
  g_asked_at = milliseconds();
  g_signal = number;
  g_sender = info->si_code <= 0 ? info->si_pid : 0;  // above 0 it comes from the kernel: a terminal
  g_cancel = true;
}

}  // namespace

void install_signal_handlers() {
  struct sigaction action {};
  action.sa_sigaction = on_stop_signal;
  action.sa_flags = SA_RESTART | SA_SIGINFO;
  sigemptyset(&action.sa_mask);
  for (int signal_number : kStopSignals) sigaddset(&action.sa_mask, signal_number);
  for (int signal_number : kStopSignals) {
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

std::string cancelled_by() {
  const int number = g_signal, sender = g_sender;
  const std::string name = number == SIGTERM ? "SIGTERM" : number == SIGHUP ? "SIGHUP" : "SIGINT";
  if (sender != 0) return name + " from process " + std::to_string(sender);
  return number == SIGINT ? "Ctrl-C" : name;
}

void throw_if_cancelled() {
  if (g_cancel) throw Cancelled();
}

}  // namespace delvox::tools
