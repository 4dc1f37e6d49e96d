// The named values of a request, from its query, a JSON body or the parts of a form, read as typed values. Every
// complaint names the field.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/units/angle.hpp"
#include "core/units/words.hpp"
#include "server/http/message.hpp"

namespace roadfix::api {

/// Closed, open where it says so; NaN and infinity are in no range.
struct Range {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  bool min_is_open = false;
};

inline constexpr Range kPositive{0.0, std::numeric_limits<double>::max(), true};
inline constexpr Range kLatitude{-90.0, 90.0};
inline constexpr Range kLongitude{-180.0, 180.0};
inline constexpr Range kDegrees{-360.0, 360.0};
inline constexpr Range kMovement{-1e5, 1e5};  ///< metres ahead or to the right between two frames
/// Integers up to here are told apart as JSON numbers; 2^53 and 2^53 + 1 are read as one.
inline constexpr double kMaxExactInteger = 9007199254740991.0;

class Fields {
 public:
  Fields() = default;
  explicit Fields(const http::Parameters& query);

  /// Adds the members of a JSON object, of which every name must be one of `known`.
  /// Throws InvalidField ("unknown-field", "duplicate-parameter", "bad-json").
  void add(nlohmann::json object, std::span<const std::string> known);
  void add_text(const std::string& name, std::string text);

  bool has(const std::string& name) const { return values_.contains(name); }
  /// Throws InvalidField ("missing-parameter", "bad-parameter", "parameter-out-of-range"), as do those below.
  double number(const std::string& name, const Range& range) const;
  std::optional<double> optional_number(const std::string& name, const Range& range) const;
  /// Of degrees.
  std::optional<Angle> optional_angle(const std::string& name, const Range& range) const;
  int integer(const std::string& name, int min, int max) const;
  std::optional<int> optional_integer(const std::string& name, int min, int max) const;
  /// Up to kMaxExactInteger, as numbers of steps and times may be.
  std::int64_t large_integer(const std::string& name, int min) const;
  std::optional<std::int64_t> optional_large_integer(const std::string& name, int min) const;
  std::string text(const std::string& name) const;
  /// The same, and the field is absent from then on.
  std::string take_text(const std::string& name);
  /// One of the words; the first where the field is absent.
  std::string word(const std::string& name, std::span<const std::string_view> words) const;
  /// The value of one of the words, likewise.
  template <typename E, std::size_t N>
  E choice(const std::string& name, const std::array<Word<E>, N>& words) const {
    return value_of(words, word(name, words_in(words))).value();
  }
  /// JSON's true and false, or text of that; false where the field is absent.
  bool flag(const std::string& name) const;
  /// So many numbers: a JSON array, or text with commas between them.
  std::optional<std::vector<double>> optional_numbers(const std::string& name, std::size_t min, std::size_t max) const;
  std::optional<std::vector<double>> optional_numbers(const std::string& name, std::size_t count) const {
    return optional_numbers(name, count, count);
  }
  /// The member of a JSON body as it is; nullptr where it is absent.
  const nlohmann::json* member(const std::string& name) const;
  /// The field has that value from then on, as if it had been sent.
  void set_number(const std::string& name, double value);
  Fields without(std::span<const std::string> left_out) const;
  /// Names and values of all but `left_out`, to compare requests by: the order in which they came does not count.
  std::string summary(std::span<const std::string> left_out) const;

 private:
  std::optional<double> whole_number(const std::string& name, const Range& range) const;

  /// Text of a query or form is kept as a JSON string with `from_text` set.
  struct Value {
    nlohmann::json json;
    bool from_text = false;
  };
  const Value* find(const std::string& name) const;
  std::map<std::string, Value> values_;
};

/// The names that a request may have, of several lists of them. A list is called ..._fields() where its names may stand
/// in the query as well as in a body (those are the parameters of a route), ..._members() where only in a body.
std::vector<std::string> joined(std::initializer_list<std::vector<std::string>> lists);

/// The whole of `text` as a finite number; nullopt for anything else.
std::optional<double> parse_number(std::string_view text);

/// A member of an object that lies deeper in a JSON body, at `place` ("poses[3]"). Throws as Fields::number does, of
/// "poses[3].lat".
double number_within(const nlohmann::json& object, const char* name, std::string_view place, const Range& range);

}  // namespace roadfix::api
