#include "progress.h"

#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "console.h"
#include "format.h"

namespace delvox::tools {
namespace {

constexpr auto kBarInterval = std::chrono::milliseconds(100);
constexpr auto kLineInterval = std::chrono::seconds(10);

// How far a queue is worked off is all that refinement can say of its own end: the bar shows the share of vertices in
// vertices plus entries waiting.
std::string bar(const Progress& progress) {
  constexpr std::size_t kWidth = 30;
  const std::size_t total = progress.vertices + progress.waiting;
  const std::size_t full = total == 0 ? 0 : kWidth * progress.vertices / total;
  return "[" + std::string(full, '#') + std::string(kWidth - full, '.') + "]";
}

}  // namespace

ProgressDisplay::Style ProgressDisplay::style_for_stderr(bool quiet) {
  if (quiet) return Style::kNone;
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal == nullptr || std::strcmp(terminal, "dumb") == 0;
  return ::isatty(STDERR_FILENO) && !dumb ? Style::kBar : Style::kLines;
}

bool ProgressPace::due(const std::string& stage, Clock::time_point now) {
  if (!told_.insert(stage).second && now - last_ < interval_) return false;
  last_ = now;
  return true;
}

ProgressDisplay::ProgressDisplay(Style style)
    : style_(style), pace_(style == Style::kBar ? ProgressPace::Clock::duration(kBarInterval) : kLineInterval) {}

void ProgressDisplay::clear() {
  if (bar_visible_) write_stderr("\r\033[K");
  bar_visible_ = false;
}

void ProgressDisplay::show(const Progress& progress) {
  if (style_ == Style::kNone || !pace_.due(progress.stage, ProgressPace::Clock::now())) return;
  std::string label = progress.stage;
  label.resize(std::max<std::size_t>(label.size(), 9), ' ');
  const std::string counts =
      grouped(progress.vertices) + " vertices, " + grouped(progress.waiting) + " waiting";
  if (style_ == Style::kBar) {
    write_stderr("\r\033[K" + label + " " + bar(progress) + " " + counts);
    bar_visible_ = true;
  } else {
    write_stderr(label + " " + counts + "\n");
  }
}

}  // namespace delvox::tools
