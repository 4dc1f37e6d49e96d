// A service that is asked until it answers: it may be busy, away for a while, or restarted.
#pragma once

#include <chrono>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "cli/fly/service_plan.hpp"
#include "server/http/client.hpp"

namespace roadfix::fly {

class ServiceConnection {
 public:
  using Send = std::function<std::optional<http::Answer>(http::Client&)>;

  explicit ServiceConnection(const ServicePlan& plan);

  /// Sends a request until it is answered, or patience is at its end. Null for an empty body. Throws InvalidInput
  /// ("service-refused"), IoFailure ("service-silent") and Interrupted ("work-stopped").
  nlohmann::json ask(const Send& send);

  /// For all answers so far.
  std::chrono::duration<double, std::milli> waited() const { return waited_; }

 private:
  using Clock = std::chrono::steady_clock;
  nlohmann::json answered(const Send& send, Clock::time_point began);
  void rest(std::chrono::milliseconds pause) const;

  http::Client client_;
  const std::string base_;
  const std::chrono::seconds patience_;
  const std::stop_token stop_;
  std::chrono::duration<double, std::milli> waited_{0.0};
};

}  // namespace roadfix::fly
