#include "server/failure_log.hpp"

#include <fmt/format.h>

#include "core/units/error.hpp"

namespace roadfix::server {
namespace {

constexpr std::chrono::seconds kPause{10};

}  // namespace

std::optional<std::string> FailureLog::line(const std::exception_ptr& thrown, int status, const std::string& request_id,
                                            Clock::time_point now) {
  if (status != 500 && status != 503) return std::nullopt;
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    const std::string text = fmt::format("request {} failed: {} [{}]", request_id, error.what(), error.code());
    if (status == 500) return text;
    if (dynamic_cast<const Interrupted*>(&error) != nullptr) return std::nullopt;  // too much work: metrics tell of it
    return throttled(error.code(), text, now);
  } catch (const std::exception& error) {
    const std::string text = fmt::format("request {} failed: {}", request_id, error.what());
    return status == 500 ? text : throttled(error.what(), text, now);
  }
}

std::optional<std::string> FailureLog::throttled(const std::string& code, const std::string& text,
                                                 Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  const auto [found, is_new] = recent_.try_emplace(code, Recent{now});
  Recent& recent = found->second;
  if (!is_new && now - recent.told < kPause) {
    ++recent.untold;
    return std::nullopt;
  }
  const int untold = recent.untold;
  recent = {now};
  return untold == 0 ? text : fmt::format("{} ({} more like it before)", text, untold);
}

}  // namespace roadfix::server
