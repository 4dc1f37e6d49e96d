// The one error hierarchy for bad outside input, corrupt data and failed I/O.
// Absence is std::optional; broken preconditions are assertions.
//
// `code` is stable and machine readable ("image-without-georeference"); the message says what is
// wrong, where (file, tile, field) and what to do. The HTTP status of each class is known only to server/api.
#pragma once

#include <stdexcept>
#include <string>

namespace roadfix {

class Error : public std::runtime_error {
 public:
  Error(std::string code, const std::string& message);
  const std::string& code() const { return code_; }

 private:
  std::string code_;
};

/// The caller sent or named something that cannot be used as it is.
class InvalidInput : public Error {
  using Error::Error;
};

/// What was asked for does not exist.
class NotFound : public Error {
  using Error::Error;
};

/// Well formed, but beyond a configured limit (bytes, pixels, cells, poses, area).
class LimitExceeded : public Error {
  using Error::Error;
};

/// Data that we or another program wrote is damaged.
class CorruptData : public Error {
  using Error::Error;
};

/// The operating system, a disk or a library refused an operation.
class IoFailure : public Error {
  using Error::Error;
};

/// The work did not end within its time limit, or was asked to stop.
class Interrupted : public Error {
  using Error::Error;
};

/// Another holds what the work needs, or changed it meanwhile: it may be there for another try.
class InUse : public Error {
  using Error::Error;
};

/// About this input and not the machine, nor an end that was asked for: another input may do.
bool is_about_input(const Error& error);

/// What `work` returns; what is wrong with its input is said of `where` ("frame.png: ...").
template <typename Work>
auto said_of(const std::string& where, const Work& work) {
  try {
    return work();
  } catch (const InvalidInput& error) {
    throw InvalidInput(error.code(), where + ": " + error.what());
  } catch (const LimitExceeded& error) {
    throw LimitExceeded(error.code(), where + ": " + error.what());
  }
}

}  // namespace roadfix
