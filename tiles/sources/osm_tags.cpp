#include "tiles/sources/osm_tags.hpp"

#include <optional>
#include <utility>

namespace roadfix {
namespace {

void skip_spaces(std::string_view& rest) {
  while (!rest.empty() && (rest.front() == ' ' || rest.front() == '\t' || rest.front() == '\n')) rest.remove_prefix(1);
}

bool skip(std::string_view& rest, std::string_view token) {
  skip_spaces(rest);
  if (!rest.starts_with(token)) return false;
  rest.remove_prefix(token.size());
  return true;
}

/// A quoted string; nullopt when none is here or it does not end.
std::optional<std::string> quoted(std::string_view& rest) {
  if (!skip(rest, "\"")) return std::nullopt;
  std::string result;
  while (!rest.empty()) {
    const char c = rest.front();
    rest.remove_prefix(1);
    if (c == '"') return result;
    if (c == '\\' && !rest.empty()) {
      result += rest.front();
      rest.remove_prefix(1);
    } else {
      result += c;
    }
  }
  return std::nullopt;
}

}  // namespace

std::map<std::string, std::string, std::less<>> parse_hstore(std::string_view text) {
  std::map<std::string, std::string, std::less<>> tags;
  do {
    std::optional<std::string> key = quoted(text);
    if (!key || !skip(text, "=>")) return tags;
    if (skip(text, "NULL")) continue;
    std::optional<std::string> value = quoted(text);
    if (!value) return tags;
    tags.insert_or_assign(std::move(*key), std::move(*value));
  } while (skip(text, ","));
  return tags;
}

}  // namespace roadfix
