// What numbers of options may be. CLI11's own checks print the largest double where one is not.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>

namespace roadfix::cli {

/// Of metres, seconds, pixels or bytes: more than anybody means, and still countable in milliseconds.
inline constexpr double kMaxNumber = 2e9;

/// Above 0 and at most `max`.
CLI::Validator positive(double max = kMaxNumber);

/// 0 or positive(max).
CLI::Validator not_negative(double max = kMaxNumber);

/// From `min` to `max`. CLI::Range takes NaN for one.
CLI::Validator between(double min, double max);

/// A whole number from 0 to 2^31 - 1, as the service takes it. CLI11 alone wraps what is negative.
CLI::Validator seed();

/// Rounded up: a time above 0 stays one.
std::chrono::milliseconds milliseconds(double seconds);

}  // namespace roadfix::cli
