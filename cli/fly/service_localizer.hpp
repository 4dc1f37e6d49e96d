// Flights followed by a running service: a track for each, and every step sent until it is answered.
#pragma once

#include <optional>
#include <string>

#include "cli/fly/campaign.hpp"
#include "cli/fly/service_plan.hpp"

namespace roadfix::fly {

/// By the service's own filter, whatever the name. Throws, when used, InvalidInput ("service-refused" with its reason,
/// "service-answer-unreadable"), IoFailure ("service-silent") and Interrupted ("work-stopped").
LocalizerFactory service_localizers(const ServicePlan& plan);

/// Version of the map that the service has by the name of the plan; nullopt where it has none. Throws the same.
std::optional<std::string> served_version(const ServicePlan& plan);

}  // namespace roadfix::fly
