#pragma once

#include <string>

namespace CLI {
class App;
}

namespace delvox::tools {

/// How much a run says, and where.
struct ConsoleOptions {
  bool quiet = false;
  bool verbose = false;
  bool json = false;
};

/// Flags --quiet and, if the verb knows them, --verbose and --json.
enum class JsonFlag { kOffered, kAbsent };
void add_console_options(CLI::App& app, ConsoleOptions& options, JsonFlag json);

/// What a verb says: results on stdout, notes on the way on stderr, and nothing else anywhere.
class Console {
 public:
  explicit Console(const ConsoleOptions& options) : options_(options) {}

  bool quiet() const { return options_.quiet; }
  bool json() const { return options_.json; }
  /// What the run chose or found on its way: stderr, unless --quiet.
  void note(const std::string& line) const;
  /// Further detail: stderr, with --verbose.
  void detail(const std::string& line) const;
  /// The result for people: stdout, unless --quiet or --json.
  void result(const std::string& text) const;
  /// The result for programs: stdout. Called with --json only.
  void machine_result(const std::string& text) const;

 private:
  ConsoleOptions options_;
};

/// Writes all of `text` to stdout. A reader that has gone away is no error; anything else throws IoError.
void write_stdout(const std::string& text);

/// Writes to stderr, ignoring failure.
void write_stderr(const std::string& text) noexcept;

}  // namespace delvox::tools
