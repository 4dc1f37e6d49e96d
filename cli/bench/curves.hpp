// Pictures of a bench as SVG, for documents.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "cli/bench/honesty.hpp"

namespace roadfix::bench {

/// Share of right answers over the probability that was said, with 95 % intervals; the diagonal is honest.
std::string reliability_svg(const Honesty& honesty);

/// Share of the queries on the map that were answered with a fix, and of those whose best guess was right (within
/// kFalseFixM), over the shorter side of the footprint. Real frames, which have no stated footprint, are left out.
std::string answered_svg(std::span<const SetResult> results);

/// The same shares over one property of simulated feature maps, from the sets in which every other property is 0;
/// nullopt where they have less than two values of it. `name` stands at the axis.
std::optional<std::string> degraded_svg(std::span<const SetResult> results, double FeatureQuality::*property,
                                        const std::string& name);

}  // namespace roadfix::bench
