// Flights followed by a running service: a track for each, and every step sent until it is answered.
#pragma once

#include "cli/fly/campaign.hpp"
#include "cli/fly/service_plan.hpp"

namespace roadfix::fly {

/// By the service's own filter, whatever the name. Throws, when used, InvalidInput ("service-refused" with its reason,
/// "service-answer-unreadable"), IoFailure ("service-silent") and Interrupted ("work-stopped").
LocalizerFactory service_localizers(const ServicePlan& plan);

}  // namespace roadfix::fly
