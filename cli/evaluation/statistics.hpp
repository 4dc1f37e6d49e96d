// Figures of many values.
#pragma once

#include <optional>
#include <vector>

namespace roadfix::evaluation {

/// nullopt for no values.
std::optional<double> mean(const std::vector<double>& values);
/// p in [0, 1]; linear between order statistics; nullopt for no values.
std::optional<double> quantile(std::vector<double> values, double p);

}  // namespace roadfix::evaluation
