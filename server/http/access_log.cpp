#include "server/http/access_log.hpp"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>

#include "core/units/error.hpp"
#include "core/units/utc_text.hpp"

namespace roadfix::http {
namespace {

/// Bytes that are not printable ASCII are written as \u00XX: a log line is always valid JSON and never two lines.
std::string json_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result.push_back('\\');
      result.push_back(c);
    } else if (byte < 0x20 || byte >= 0x7f) {
      result += fmt::format("\\u{:04x}", byte);
    } else {
      result.push_back(c);
    }
  }
  result.push_back('"');
  return result;
}

/// Empty where the value is.
std::string member(std::string_view name, const std::string& value) {
  return value.empty() ? "" : fmt::format(",\"{}\":{}", name, json_string(value));
}

std::shared_ptr<spdlog::logger> open(const std::string& target) {
  if (target.empty()) return nullptr;
  try {
    std::shared_ptr<spdlog::sinks::sink> sink;
    if (target == "-") {
      sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    } else {
      sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(target);
    }
    auto logger = std::make_shared<spdlog::logger>("access", sink);
    logger->set_pattern("%v");
    logger->flush_on(spdlog::level::info);
    return logger;
  } catch (const spdlog::spdlog_ex& error) {
    throw IoFailure("access-log", fmt::format("the access log {} cannot be written: {}", target, error.what()));
  }
}

}  // namespace

std::string json_line(const AccessRecord& r) {
  return fmt::format(
      R"({{"time":"{}","id":{},"client":{},"method":{},"target":{},"route":{},"status":{},"bytes":{},"ms":{:.3f}{}{}}})",
      utc_text(r.time), json_string(r.id), json_string(r.client), json_string(r.method), json_string(r.target),
      json_string(r.route), r.status, r.bytes, r.ms, member("problem", r.problem), member("answer", r.answer));
}

AccessLog::AccessLog(const std::string& target) : logger_(open(target)) {}

void AccessLog::write(const AccessRecord& record) {
  if (logger_) logger_->info("{}", json_line(record));
}

}  // namespace roadfix::http
