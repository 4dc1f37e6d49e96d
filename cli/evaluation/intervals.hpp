// How far a figure from few samples can be trusted.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace roadfix::evaluation {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// [low, high]
nlohmann::json to_json(const Interval& interval);

/// Clopper and Pearson's exact interval of a proportion of `hits` in `n`, two-sided at `confidence` in (0, 1);
/// [0, 1] for n = 0.
Interval clopper_pearson(int hits, int n, double confidence = 0.95);

/// Where the mean of `n` values of chi^2 with `degrees` lies in 95 of 100 cases (Wilson and Hilferty's approximation,
/// good to 1 % from n * degrees = 10 and never below 0): the band of a consistent NEES.
Interval chi_square_mean_band(int n, int degrees);

}  // namespace roadfix::evaluation
