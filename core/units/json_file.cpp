#include "core/units/json_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units/error.hpp"
#include "core/units/names_once.hpp"

namespace roadfix {
namespace {

using nlohmann::json;

[[noreturn]] void complain(const JsonFile& file, const std::string& code, std::string_view what) {
  throw InvalidInput(code, fmt::format("{}: {}{}{}", file.name, what, file.remedy.empty() ? "" : "; ", file.remedy));
}

}  // namespace

json parse_json(std::string_view text, const JsonFile& file) {
  try {
    return parse_with_names_once(text, [&](const std::string& name) {
      complain(file, file.field_code, fmt::format("'{}' is given twice in one object: remove one of them", name));
    });
  } catch (const json::parse_error& error) {
    complain(file, file.json_code, fmt::format("byte {} is no JSON: {}", error.byte, error.what()));
  } catch (const json::out_of_range& error) {
    complain(file, file.json_code, error.what());
  }
}

JsonField::JsonField(const json& value, const JsonFile& file, std::string place)
    : value_(value), file_(file), place_(std::move(place)) {}

void JsonField::refuse(std::string_view what) const {
  complain(file_, file_.field_code, fmt::format("{} {}", place_.empty() ? "the document" : place_, what));
}

void JsonField::require(bool condition, std::string_view what) const {
  if (!condition) refuse(what);
}

void JsonField::allow_only(const std::vector<std::string_view>& keys) const {
  require(value_.is_object(), "must be an object");
  for (const auto& [key, unused] : value_.items()) {
    if (std::ranges::find(keys, key) == keys.end()) {
      refuse(fmt::format("has the unknown field '{}'; known are: {}", key, fmt::join(keys, ", ")));
    }
  }
}

JsonField JsonField::at(const std::string& key) const {
  require(value_.is_object(), "must be an object");
  if (!has(key)) refuse(fmt::format("lacks the field '{}'", key));
  return {value_.at(key), file_, place_.empty() ? key : place_ + "." + key};
}

std::vector<JsonField> JsonField::elements() const {
  require(value_.is_array(), "must be an array");
  std::vector<JsonField> fields;
  for (std::size_t i = 0; i < value_.size(); ++i) {
    fields.push_back(JsonField(value_[i], file_, fmt::format("{}[{}]", place_, i)));
  }
  return fields;
}

bool JsonField::truth() const {
  require(value_.is_boolean(), "must be true or false");
  return value_.get<bool>();
}

std::string JsonField::text() const {
  require(value_.is_string(), "must be a string");
  return value_.get<std::string>();
}

double JsonField::number(double low, double high) const {
  require(value_.is_number(), "must be a number");
  const auto number = value_.get<double>();
  if (!(number >= low && number <= high)) {
    refuse(fmt::format("is {}; it must lie within {} to {}", number, low, high));
  }
  return number;
}

std::int64_t JsonField::whole_number(double low, double high) const {
  const double value = number(low, high);
  require(value == std::floor(value), "must be a whole number");
  return static_cast<std::int64_t>(value);
}

std::string JsonField::one_of(const std::vector<std::string_view>& words) const {
  std::string word = text();
  if (std::ranges::find(words, word) == words.end()) {
    refuse(fmt::format("is '{}'; it must be one of: {}", word, fmt::join(words, ", ")));
  }
  return word;
}

}  // namespace roadfix
