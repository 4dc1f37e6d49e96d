#include "server/http/metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace roadfix::http {
namespace {

void header(std::string& text, std::string_view name, std::string_view type, std::string_view help) {
  fmt::format_to(std::back_inserter(text), "# HELP {0} {2}\n# TYPE {0} {1}\n", name, type, help);
}

}  // namespace

void Metrics::count(const std::string& method, const std::string& route, int status, std::chrono::nanoseconds time,
                    std::size_t bytes) {
  const double seconds = std::chrono::duration<double>(time).count();
  const auto bucket = static_cast<std::size_t>(std::ranges::lower_bound(kBounds, seconds) - kBounds.begin());
  const std::lock_guard lock(mutex_);
  ++requests_[{{method, route}, status}];
  Latency& latency = latencies_[{method, route}];
  ++latency.buckets[bucket];
  ++latency.count;
  latency.sum_s += seconds;
  bytes_ += bytes;
}

void Metrics::count(const std::string& name, const std::string& labels) {
  const std::lock_guard lock(mutex_);
  ++counted_[name][labels];
}

void Metrics::describe(std::string name, std::string help) { described_.emplace(std::move(name), std::move(help)); }

void Metrics::gauge(std::string name, std::string help, std::function<double()> value) {
  gauges_.push_back({std::move(name), std::move(help), std::move(value)});
}

std::string Metrics::text() const {
  std::string gauges;  // first and without the lock: some take their time
  for (const Gauge& gauge : gauges_) {
    header(gauges, gauge.name, "gauge", gauge.help);
    fmt::format_to(std::back_inserter(gauges), "{} {}\n", gauge.name, gauge.value());
  }
  std::string text;
  const auto out = std::back_inserter(text);
  const std::lock_guard lock(mutex_);
  header(text, "roadfix_requests_total", "counter", "Requests answered, by route and status.");
  for (const auto& [key, n] : requests_) {
    fmt::format_to(out, "roadfix_requests_total{{method=\"{}\",route=\"{}\",status=\"{}\"}} {}\n", key.first.first,
                   key.first.second, key.second, n);
  }
  header(text, "roadfix_request_seconds", "histogram", "Time from the head of a request to the end of its answer.");
  for (const auto& [key, latency] : latencies_) {
    const std::string labels = fmt::format("method=\"{}\",route=\"{}\"", key.first, key.second);
    std::uint64_t below = 0;
    for (std::size_t i = 0; i <= kBounds.size(); ++i) {
      below += latency.buckets[i];
      const std::string bound = i < kBounds.size() ? fmt::format("{}", kBounds[i]) : "+Inf";
      fmt::format_to(out, "roadfix_request_seconds_bucket{{{},le=\"{}\"}} {}\n", labels, bound, below);
    }
    fmt::format_to(out, "roadfix_request_seconds_sum{{{0}}} {1}\nroadfix_request_seconds_count{{{0}}} {2}\n", labels,
                   latency.sum_s, latency.count);
  }
  for (const auto& [name, help] : described_) {
    header(text, name, "counter", help);
    const auto values = counted_.find(name);
    if (values == counted_.end()) continue;
    for (const auto& [labels, n] : values->second) fmt::format_to(out, "{}{{{}}} {}\n", name, labels, n);
  }
  header(text, "roadfix_response_bytes_total", "counter", "Bytes of answers before compression.");
  fmt::format_to(out, "roadfix_response_bytes_total {}\n", bytes_);
  header(text, "roadfix_requests_in_flight", "gauge", "Requests being answered.");
  fmt::format_to(out, "roadfix_requests_in_flight {}\n", in_flight.load());
  header(text, "roadfix_connections", "gauge", "Open connections that have a thread.");
  fmt::format_to(out, "roadfix_connections {}\n", connections.load());
  return text + gauges;
}

}  // namespace roadfix::http
