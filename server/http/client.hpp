// A client of a service such as this one: one connection, kept open and opened anew when it was lost.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace roadfix::http {

struct Answer {
  int status = 0;
  std::string body;
  std::optional<std::chrono::seconds> retry_after;
};

class Client {
 public:
  /// `base` is "http://HOST" or "http://HOST:PORT". Throws InvalidInput ("bad-url"). An answer that takes longer than
  /// `patience` counts as lost.
  Client(const std::string& base, std::chrono::seconds patience);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  // nullopt where no answer came: nobody listens, or the connection was lost before all of it was there. Whether a
  // request was carried out is not known then.
  std::optional<Answer> get(const std::string& target);
  std::optional<Answer> post(const std::string& target, const std::string& body, const std::string& content_type);
  std::optional<Answer> remove(const std::string& target);  ///< DELETE

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadfix::http
