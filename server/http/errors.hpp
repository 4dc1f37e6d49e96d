// Errors of the protocol itself, in the hierarchy of core/units/error.hpp: server/api gives them a status.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "core/units/error.hpp"

namespace roadfix::http {

/// The path exists, the method does not.
class MethodNotAllowed : public InvalidInput {
 public:
  MethodNotAllowed(const std::string& method, std::string allowed);
  const std::string& allowed() const { return allowed_; }

 private:
  std::string allowed_;
};

/// A field of the request (query parameter, header, member of a JSON body as "poses[3].lat") cannot be used.
class InvalidField : public InvalidInput {
 public:
  InvalidField(std::string code, const std::string& field, const std::string& message,
               std::optional<std::size_t> byte = std::nullopt);
  const std::string& field() const { return field_; }
  /// Position in the body, or in the text of the field where that is base64; where there is one.
  std::optional<std::size_t> byte() const { return byte_; }

 private:
  std::string field_;
  std::optional<std::size_t> byte_;
};

/// The InvalidField ("duplicate-parameter") of a name for which there are two values.
InvalidField given_twice(const std::string& name);

/// Work for a client that has hung up was given up ("client-gone"). Nobody reads this but the logs.
class ClientGone : public Interrupted {
 public:
  ClientGone();
};

/// For work that others let through in no time.
inline constexpr std::chrono::seconds kRetrySoon{1};

/// More work waits than the service takes on; worth trying again.
class Busy : public Interrupted {
 public:
  Busy(const std::string& message, std::chrono::seconds retry_after);
  std::chrono::seconds retry_after() const { return retry_after_; }

 private:
  std::chrono::seconds retry_after_;
};

}  // namespace roadfix::http
