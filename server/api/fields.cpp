#include "server/api/fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/units/text.hpp"
#include "server/http/errors.hpp"

namespace roadfix::api {
namespace {

using http::InvalidField;
using nlohmann::json;

[[noreturn]] void missing(const std::string& name) {
  throw InvalidField("missing-parameter", name, fmt::format("'{}' is missing", name));
}

std::string shown(const json& value) {
  return shortened(
      value.is_string() ? value.get<std::string>() : value.dump(-1, ' ', true, json::error_handler_t::replace), 40);
}

double to_number(const std::string& name, const json& value) {
  if (value.is_number()) return value.get<double>();
  throw InvalidField("bad-parameter", name, fmt::format("'{}' must be a number, not '{}'", name, shown(value)));
}

bool has_lists(const json& list) {
  return std::ranges::any_of(list, [](const json& element) { return element.is_array(); });
}

void require_in(const Range& range, const std::string& name, double value) {
  const bool below = range.min_is_open ? value <= range.min : value < range.min;
  if (!below && value <= range.max) return;
  const bool unbounded = range.max == std::numeric_limits<double>::max();
  throw InvalidField(
      "parameter-out-of-range", name,
      fmt::format("'{}' is {}; it must be {} {}{}", name, value, range.min_is_open ? "above" : "at least", range.min,
                  unbounded ? "" : fmt::format(" and at most {}", range.max)));
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const auto value = as_number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

double number_within(const json& object, const char* name, std::string_view place, const Range& range) {
  const std::string field = fmt::format("{}.{}", place, name);
  const auto found = object.find(name);
  if (found == object.end()) missing(field);
  const double value = to_number(field, *found);
  require_in(range, field, value);
  return value;
}

Fields::Fields(const http::Parameters& query) {
  for (const auto& [name, value] : query) add_text(name, value);
}

void Fields::add_text(const std::string& name, std::string text) {
  if (!values_.try_emplace(name, Value{std::move(text), true}).second) throw http::given_twice(name);
}

void Fields::add(json object, std::span<const std::string> known) {
  if (!object.is_object()) throw InvalidField("bad-json", "body", "the JSON body must be an object");
  for (auto& [name, value] : object.get_ref<json::object_t&>()) {
    if (std::ranges::find(known, name) == known.end()) {
      throw InvalidField(
          "unknown-field", name,
          fmt::format("'{}' is not a field of this request; allowed: {}", shown(name), fmt::join(known, ", ")));
    }
    if (value.is_null()) continue;
    if (!values_.try_emplace(name, Value{std::move(value), false}).second) throw http::given_twice(name);
  }
}

void Fields::set_number(const std::string& name, double value) { values_[name] = {value, false}; }

Fields Fields::without(std::span<const std::string> left_out) const {
  Fields result;
  for (const auto& [name, value] : values_) {
    if (std::ranges::find(left_out, name) == left_out.end()) result.values_.emplace(name, value);
  }
  return result;
}

const Fields::Value* Fields::find(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? nullptr : &found->second;
}

std::optional<double> Fields::optional_number(const std::string& name, const Range& range) const {
  const Value* value = find(name);
  if (value == nullptr) return std::nullopt;
  std::optional<double> number;
  if (value->from_text) {
    number = parse_number(value->json.get_ref<const std::string&>());
    if (!number) {
      throw InvalidField("bad-parameter", name,
                         fmt::format("'{}' must be a finite number, not '{}'", name, shown(value->json)));
    }
  } else {
    number = to_number(name, value->json);
  }
  require_in(range, name, *number);
  return number;
}

double Fields::number(const std::string& name, const Range& range) const {
  const auto value = optional_number(name, range);
  if (!value) missing(name);
  return *value;
}

std::optional<Angle> Fields::optional_angle(const std::string& name, const Range& range) const {
  const auto degrees = optional_number(name, range);
  return degrees ? std::optional(Angle::degrees(*degrees)) : std::nullopt;
}

std::optional<double> Fields::whole_number(const std::string& name, const Range& range) const {
  const auto value = optional_number(name, range);
  if (value && *value != std::floor(*value)) {
    throw InvalidField("bad-parameter", name, fmt::format("'{}' must be a whole number, not {}", name, *value));
  }
  return value;
}

std::optional<int> Fields::optional_integer(const std::string& name, int min, int max) const {
  const auto value = whole_number(name, {static_cast<double>(min), static_cast<double>(max)});
  return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
}

int Fields::integer(const std::string& name, int min, int max) const {
  const auto value = optional_integer(name, min, max);
  if (!value) missing(name);
  return *value;
}

std::optional<std::int64_t> Fields::optional_large_integer(const std::string& name, int min) const {
  const auto value = whole_number(name, {static_cast<double>(min), kMaxExactInteger});
  return value ? std::optional(static_cast<std::int64_t>(*value)) : std::nullopt;
}

std::int64_t Fields::large_integer(const std::string& name, int min) const {
  const auto value = optional_large_integer(name, min);
  if (!value) missing(name);
  return *value;
}

std::string Fields::text(const std::string& name) const {
  const Value* value = find(name);
  if (value == nullptr) missing(name);
  if (!value->json.is_string()) throw InvalidField("bad-parameter", name, fmt::format("'{}' must be text", name));
  return value->json.get<std::string>();
}

std::string Fields::take_text(const std::string& name) {
  if (const Value* value = find(name); value == nullptr || !value->json.is_string()) return text(name);
  return std::move(values_.extract(name).mapped().json.get_ref<std::string&>());
}

std::string Fields::word(const std::string& name, std::span<const std::string_view> words) const {
  if (!has(name)) return std::string(words.front());
  std::string value = text(name);
  if (std::ranges::find(words, value) == words.end()) {
    throw InvalidField("bad-parameter", name,
                       fmt::format("'{}' is '{}'; it must be one of: {}", name, shown(value), fmt::join(words, ", ")));
  }
  return value;
}

bool Fields::flag(const std::string& name) const {
  const Value* value = find(name);
  if (value == nullptr) return false;
  if (value->json.is_boolean()) return value->json.get<bool>();
  if (value->from_text && value->json == "true") return true;
  if (value->from_text && value->json == "false") return false;
  throw InvalidField("bad-parameter", name,
                     fmt::format("'{}' must be true or false, not {}", name, shown(value->json)));
}

std::optional<std::vector<double>> Fields::optional_numbers(const std::string& name, std::size_t min,
                                                            std::size_t max) const {
  const Value* value = find(name);
  if (value == nullptr) return std::nullopt;
  std::vector<double> numbers;
  if (value->from_text) {
    const auto& text = value->json.get_ref<const std::string&>();
    const auto commas = static_cast<std::size_t>(std::ranges::count(text, ','));
    if (commas < max) numbers = numbers_in(text, ',').value_or(std::vector<double>());
  } else if (value->json.is_array() && value->json.size() <= max && !has_lists(value->json)) {
    for (const json& element : value->json) numbers.push_back(to_number(name, element));
  }
  if (numbers.size() < min || numbers.size() > max) {
    throw InvalidField(
        "bad-parameter", name,
        fmt::format("'{}' must be {} numbers {}, not '{}'", name,
                    min == max ? fmt::to_string(min) : fmt::format("{} to {}", min, max),
                    value->from_text ? "with commas between them" : "in one flat list", shown(value->json)));
  }
  return numbers;
}

const json* Fields::member(const std::string& name) const {
  const Value* value = find(name);
  return value == nullptr || value->from_text ? nullptr : &value->json;
}

std::string Fields::summary(std::span<const std::string> left_out) const {
  json kept = json::object();
  for (const auto& [name, value] : values_) {
    if (std::ranges::find(left_out, name) == left_out.end()) kept[name] = value.json;
  }
  return kept.dump(-1, ' ', true, json::error_handler_t::replace);
}

std::vector<std::string> joined(std::initializer_list<std::vector<std::string>> lists) {
  std::vector<std::string> all;
  for (const std::vector<std::string>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace roadfix::api
