#include "console.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>

#include "delvox/core/errors.h"

namespace delvox::tools {

void add_console_options(CLI::App& app, ConsoleOptions& options, JsonFlag json) {
  auto* quiet = app.add_flag("--quiet", options.quiet, "Say nothing; a run that fails prints one line");
  app.add_flag("--verbose", options.verbose, "Say more on the way")->excludes(quiet);
  if (json == JsonFlag::kOffered) app.add_flag("--json", options.json, "Print the result as JSON on stdout");
}

void Console::note(const std::string& line) const {
  if (!options_.quiet) write_stderr(line + "\n");
}

void Console::detail(const std::string& line) const {
  if (options_.verbose) write_stderr(line + "\n");
}

void Console::result(const std::string& text) const {
  if (!options_.quiet && !options_.json) write_stdout(text);
}

void Console::machine_result(const std::string& text) const { write_stdout(text); }

void write_stdout(const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(STDOUT_FILENO, text.data() + done, text.size() - done);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno == EPIPE) {
      return;
    } else if (errno != EINTR) {
      throw IoError(std::string("standard output: cannot be written: ") + std::strerror(errno) +
                    "; free some space or send it elsewhere");
    }
  }
}

void write_stderr(const std::string& text) noexcept {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(STDERR_FILENO, text.data() + done, text.size() - done);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      return;
    }
  }
}

}  // namespace delvox::tools
