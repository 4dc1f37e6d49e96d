// One JSON object per request and line.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

namespace spdlog {
class logger;
}

namespace roadfix::http {

struct AccessRecord {
  std::chrono::system_clock::time_point time;
  std::string id;
  std::string client;
  std::string method;
  std::string target;  ///< path and query as sent
  std::string route;   ///< pattern of the route, empty where none matched
  int status = 0;
  std::size_t bytes = 0;
  double ms = 0.0;
  std::string problem = {};  ///< code of the error that was answered, empty where it was none
  std::string answer = {};   ///< Response::answer
};

std::string json_line(const AccessRecord& record);

class AccessLog {
 public:
  /// "-" = standard error, empty = none, otherwise a file that is appended to. Throws IoFailure ("access-log").
  explicit AccessLog(const std::string& target);
  void write(const AccessRecord& record);

 private:
  std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace roadfix::http
