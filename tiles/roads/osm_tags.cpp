#include "tiles/roads/osm_tags.hpp"

#include <cpl_error.h>
#include <cpl_json.h>

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

TagMap parse_json(std::string_view text) {
  const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
  TagMap tags;
  CPLJSONDocument document;
  if (!document.LoadMemory(std::string(text))) return tags;
  for (const CPLJSONObject& tag : document.GetRoot().GetChildren()) {
    if (tag.GetType() != CPLJSONObject::Type::Null) tags.insert_or_assign(tag.GetName(), tag.ToString());
  }
  return tags;
}

}  // namespace

TagMap parse_hstore(std::string_view text) {
  TagMap tags;
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

TagMap parse_tags(std::string_view text) {
  skip_spaces(text);
  return text.starts_with('{') ? parse_json(text) : parse_hstore(text);
}

}  // namespace roadfix
