// JSON that a person wrote, read field by field: whatever is wrong is named with its place and what to do.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/units/words.hpp"

namespace roadfix {

/// What its complaints are made of.
struct JsonFile {
  std::string name;        ///< "bench manifest": they begin with it
  std::string field_code;  ///< of InvalidInput about a field
  std::string json_code;   ///< of InvalidInput about text that is no JSON
  std::string remedy;      ///< they end with it; may be empty
};

/// Throws InvalidInput, also of a name that an object has twice.
nlohmann::json parse_json(std::string_view text, const JsonFile& file);

/// A value that knows its place. Refers to the value and the file. All but the questions throw InvalidInput.
class JsonField {
 public:
  JsonField(const nlohmann::json& value, const JsonFile& file) : JsonField(value, file, {}) {}

  [[noreturn]] void refuse(std::string_view what) const;

  bool has(const std::string& key) const { return value_.contains(key); }
  bool is_null() const { return value_.is_null(); }
  bool is_number() const { return value_.is_number(); }
  bool is_array() const { return value_.is_array(); }
  bool is_object() const { return value_.is_object(); }

  void allow_only(const std::vector<std::string_view>& keys) const;
  JsonField at(const std::string& key) const;
  std::vector<JsonField> elements() const;
  bool truth() const;
  std::string text() const;
  double number(double low, double high) const;
  std::int64_t whole_number(double low, double high) const;
  std::string one_of(const std::vector<std::string_view>& words) const;
  template <typename E, std::size_t N>
  E one_of(const std::array<Word<E>, N>& words) const {
    const auto names = words_in(words);
    return value_of(words, one_of(std::vector<std::string_view>(names.begin(), names.end()))).value();
  }

 private:
  JsonField(const nlohmann::json& value, const JsonFile& file, std::string place);
  void require(bool condition, std::string_view what) const;

  const nlohmann::json& value_;
  const JsonFile& file_;
  std::string place_;  ///< "maps[0].name"; empty for the whole
};

}  // namespace roadfix
