// Flights followed by a running service: a track for each, and every step sent until it is answered.
#pragma once

#include "cli/fly/campaign.hpp"
#include "cli/fly/service_plan.hpp"

namespace roadfix::fly {

/// Filters of the service: "default" and "paper". Throws, when used, InvalidInput ("filter-unknown", "service-refused"
/// with its reason), IoFailure ("service-silent") and Interrupted ("flight-stopped").
LocalizerFactory service_localizers(const ServicePlan& plan);

}  // namespace roadfix::fly
