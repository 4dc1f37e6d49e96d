#include "cli/date_check.hpp"

#include <fmt/format.h>

#include <chrono>
#include <regex>
#include <string>

namespace roadfix::cli {
namespace {

bool is_iso_date(const std::string& text) {
  static const std::regex pattern(R"((\d{4})(?:-(\d\d)(?:-(\d\d)(?:T(?:[01]\d|2[0-3]):[0-5]\d(?::[0-5]\d(?:\.\d+)?)?)"
                                  R"((?:Z|[+-](?:[01]\d|2[0-3]):[0-5]\d)?)?)?)?)");
  std::smatch parts;
  if (!std::regex_match(text, parts, pattern)) return false;
  const auto part = [&](std::size_t i) { return parts[i].matched ? std::stoi(parts[i]) : 1; };
  return std::chrono::year_month_day(std::chrono::year(part(1)), std::chrono::month(static_cast<unsigned>(part(2))),
                                     std::chrono::day(static_cast<unsigned>(part(3))))
      .ok();
}

}  // namespace

CLI::Validator iso_date() {
  return {[](std::string& text) -> std::string {
            if (text.empty() || is_iso_date(text)) return {};
            return fmt::format("must be a date like 2023, 2023-02, 2023-02-06 or 2023-02-06T10:30Z (ISO 8601), not {}",
                               text);
          },
          "DATE"};
}

}  // namespace roadfix::cli
