#include "server/http/metrics.hpp"

#include <gmock/gmock.h>

namespace roadfix::http {
namespace {

using ::testing::HasSubstr;

TEST(Metrics, CountsByRouteAndStatusWithCumulativeBuckets) {
  Metrics metrics;
  metrics.gauge("roadfix_maps", "Maps being served.", [] { return 3.0; });
  metrics.count("GET", "/v1/maps", 200, std::chrono::milliseconds(3), 100);
  metrics.count("GET", "/v1/maps", 200, std::chrono::milliseconds(30), 100);
  metrics.count("GET", "/v1/maps", 404, std::chrono::minutes(2), 10);
  const std::string text = metrics.text();
  EXPECT_THAT(text, HasSubstr("roadfix_requests_total{method=\"GET\",route=\"/v1/maps\",status=\"200\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("route=\"/v1/maps\",le=\"0.0025\"} 0\n"));
  EXPECT_THAT(text, HasSubstr("route=\"/v1/maps\",le=\"0.005\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("route=\"/v1/maps\",le=\"30\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("route=\"/v1/maps\",le=\"+Inf\"} 3\n"));
  EXPECT_THAT(text, HasSubstr("roadfix_response_bytes_total 210\n"));
  EXPECT_THAT(text, HasSubstr("# TYPE roadfix_maps gauge\nroadfix_maps 3\n"));
}

TEST(Metrics, CountsKindsOfAnswersByTheirLabels) {
  Metrics metrics;
  metrics.describe("roadfix_answers_total", "Answers.");
  EXPECT_THAT(metrics.text(), HasSubstr("# TYPE roadfix_answers_total counter\n")) << "also before the first";
  metrics.count("roadfix_answers_total", "status=\"fix\"");
  metrics.count("roadfix_answers_total", "status=\"no_fix\"");
  metrics.count("roadfix_answers_total", "status=\"fix\"");
  EXPECT_THAT(metrics.text(),
              HasSubstr("roadfix_answers_total{status=\"fix\"} 2\nroadfix_answers_total{status=\"no_fix\"} 1\n"));
}

TEST(Metrics, CountsWhileAGaugeIsRead) {
  Metrics metrics;
  metrics.gauge("slow", "One that waits for a request.", [&] {
    metrics.count("GET", "/", 200, std::chrono::milliseconds(1), 1);
    return 1.0;
  });
  EXPECT_THAT(metrics.text(), HasSubstr("slow 1\n"));
}

}  // namespace
}  // namespace roadfix::http
