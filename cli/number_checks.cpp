#include "cli/number_checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "core/units/text.hpp"

namespace roadfix::cli {
namespace {

CLI::Validator number_within(double min, bool is_open, double max, std::string name) {
  return {[=](std::string& text) -> std::string {
            double value = 0.0;
            const bool is_number = CLI::detail::lexical_cast(text, value);
            if (is_number && value <= max && (is_open ? value > min : value >= min)) return {};
            return fmt::format("must be a number {} {} and at most {}, not {}", is_open ? "above" : "of at least", min,
                               max, text);
          },
          std::move(name)};
}

}  // namespace

CLI::Validator positive(double max) { return number_within(0.0, true, max, "POSITIVE"); }

CLI::Validator not_negative(double max) { return number_within(0.0, false, max, "NONNEGATIVE"); }

CLI::Validator between(double min, double max) {
  return number_within(min, false, max, fmt::format("in [{} - {}]", min, max));
}

CLI::Validator seed() {
  return {[](std::string& text) -> std::string {
            if (as_number<std::int32_t>(text).value_or(-1) >= 0) return {};
            return fmt::format("must be a whole number from 0 to {}, not {}", std::numeric_limits<std::int32_t>::max(),
                               text);
          },
          "SEED"};
}

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(1000.0 * seconds)));
}

}  // namespace roadfix::cli
