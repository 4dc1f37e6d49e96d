#include "server/api/media.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/units/error.hpp"
#include "core/units/text.hpp"

namespace roadfix::api {
namespace {

struct Preference {
  std::string range;
  double quality = 1.0;
};

std::string without_spaces(std::string_view text) {
  std::string result = lower_case(text);
  std::erase_if(result, [](char c) { return c == ' ' || c == '\t'; });
  return result;
}

Preference preference(std::string_view element) {
  const std::size_t semicolon = std::min(element.find(';'), element.size());
  Preference result{without_spaces(element.substr(0, semicolon))};
  const std::string parameters = without_spaces(element.substr(semicolon));
  const std::size_t q = parameters.find(";q=");
  if (q != std::string::npos) {
    const std::string_view value = std::string_view(parameters).substr(q + 3);
    result.quality = parse_number(value.substr(0, value.find(';'))).value_or(0.0);
  }
  return result;
}

/// 0 = no match, 1 = "*/*", 2 = "image/*", 3 = the type itself.
int specificity(std::string_view range, std::string_view type) {
  if (range == type) return 3;
  if (range == "*/*") return 1;
  return range.ends_with("/*") && type.starts_with(range.substr(0, range.size() - 1)) ? 2 : 0;
}

/// That of the most specific range that matches (RFC 9110 12.5.1).
double quality(std::span<const Preference> preferences, std::string_view type) {
  int best = 0;
  double result = 0.0;
  for (const Preference& p : preferences) {
    const int match = specificity(p.range, type);
    if (match > best) {
      best = match;
      result = p.quality;
    }
  }
  return result;
}

}  // namespace

const Media& negotiated(std::string_view accept, std::span<const Media> offered) {
  if (accept.empty()) return offered.front();
  std::vector<Preference> preferences;
  for (const std::string_view element : split(accept, ',')) preferences.push_back(preference(element));
  const auto best = std::ranges::max_element(offered, {}, [&](const Media& m) { return quality(preferences, m.type); });
  if (quality(preferences, best->type) > 0.0) return *best;
  std::string types;
  for (const Media& media : offered) types += fmt::format("{}{}", types.empty() ? "" : ", ", media.type);
  throw InvalidInput("not-acceptable", fmt::format("Accept matches none of {}: name one, or use format=", types));
}

const Media& media_asked_for(const http::Request& request, const Fields& fields, std::span<const Media> offered) {
  if (!fields.has("format")) return negotiated(request.header("accept"), offered);
  std::vector<std::string_view> names;
  for (const Media& media : offered) names.push_back(media.name);
  return *std::ranges::find(offered, fields.word("format", names), &Media::name);
}

}  // namespace roadfix::api
