#pragma once

#include "delvox/core/errors.h"

namespace delvox::tools {

inline constexpr int kExitDone = 0;            ///< done, every promise verified
inline constexpr int kExitUsage = 2;           ///< an option or argument makes no sense
inline constexpr int kExitInput = 3;           ///< input cannot be read or makes no sense
inline constexpr int kExitNothing = 4;         ///< nothing to mesh
inline constexpr int kExitBroken = 5;          ///< a limit stopped the run or forbade it, or a promise does not hold
inline constexpr int kExitOutput = 6;          ///< output cannot be written
inline constexpr int kExitCancelled = 130;     ///< Ctrl-C, SIGTERM

/// The work is done and written, but a limit stopped it or a promise does not hold (exit 5).
class PromiseBroken : public Error {
 public:
  using Error::Error;
};

/// The run was not begun, since the forecast exceeds a limit; nothing is written (exit 5).
class RunRefused : public Error {
 public:
  using Error::Error;
};

}  // namespace delvox::tools
