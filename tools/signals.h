#pragma once

#include <atomic>
#include <string>

namespace delvox::tools {

/// Ctrl-C, SIGTERM and SIGHUP ask the run to stop; another one later stops it at once, after removing what is unfinished
/// (exit 130). SIGPIPE and SIGXFSZ are ignored: writing then fails with an error that is reported.
void install_signal_handlers();

/// True once a signal has asked the run to stop: for RunControl::cancel.
const std::atomic<bool>& cancel_requested();

/// Who asked the run to stop: "Ctrl-C", or "SIGTERM from process 4711". pre: cancel_requested()
std::string cancelled_by();

/// Throws Cancelled if a signal has asked the run to stop. Called between stages that do not look themselves.
void throw_if_cancelled();

}  // namespace delvox::tools
