#pragma once

#include <stdexcept>
#include <string>

namespace delvox {

/// Base of everything the library throws. what() is one line: which file or value, the cause, the mend.
/// Reaching a limit is a result (RunReport), not an exception.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option or argument makes no sense (the program exits with 2).
class OptionError : public Error {
 public:
  using Error::Error;
};

/// Input cannot be read or makes no sense (exit 3).
class InputError : public Error {
 public:
  using Error::Error;
};

/// There is nothing to mesh: isovalue outside the range, empty crop (exit 4).
class NothingToMesh : public Error {
 public:
  using Error::Error;
};

/// Output cannot be written (exit 6).
class IoError : public Error {
 public:
  using Error::Error;
};

/// The caller cancelled the run (exit 130).
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace delvox
