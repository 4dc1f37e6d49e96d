// Counters of the service in the text format of Prometheus (version 0.0.4).
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace roadfix::http {

class Metrics {
 public:
  /// `route` is the pattern, never the path: the number of series stays bounded.
  void count(const std::string& method, const std::string& route, int status, std::chrono::nanoseconds time,
             std::size_t bytes);

  /// Counts one more of a kind: "roadfix_answers_total", "kind=\"fix\",status=\"no_fix\"". Few kinds.
  void count(const std::string& name, const std::string& labels);
  /// What `name` counts, said before its values. Register before the service starts.
  void describe(std::string name, std::string help);

  /// A value read when it is asked for. Register before the service starts.
  void gauge(std::string name, std::string help, std::function<double()> value);

  std::atomic<int> in_flight = 0;
  std::atomic<int> connections = 0;

  std::string text() const;

 private:
  /// Upper bounds of the latency buckets in seconds; the last bucket is unbounded.
  static constexpr std::array kBounds{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1,
                                      0.25,  0.5,    1.0,   2.5,  5.0,   10.0, 30.0};
  struct Latency {
    std::array<std::uint64_t, kBounds.size() + 1> buckets{};
    std::uint64_t count = 0;
    double sum_s = 0.0;
  };
  struct Gauge {
    std::string name;
    std::string help;
    std::function<double()> value;
  };
  using RouteKey = std::pair<std::string, std::string>;  ///< method, route

  mutable std::mutex mutex_;
  std::map<std::pair<RouteKey, int>, std::uint64_t> requests_;
  std::map<RouteKey, Latency> latencies_;
  std::uint64_t bytes_ = 0;
  std::map<std::string, std::string> described_;                         ///< help by name
  std::map<std::string, std::map<std::string, std::uint64_t>> counted_;  ///< by name and labels
  std::vector<Gauge> gauges_;
};

/// Counts up for as long as it lives.
class Counted {
 public:
  explicit Counted(std::atomic<int>& counter) : counter_(counter) { ++counter_; }
  ~Counted() { --counter_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::atomic<int>& counter_;
};

}  // namespace roadfix::http
