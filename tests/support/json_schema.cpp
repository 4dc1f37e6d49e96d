#include "tests/support/json_schema.hpp"

#include <algorithm>
#include <functional>
#include <map>

namespace roadfix::testing {
namespace {

using nlohmann::json;

bool is_of_type(const json& value, const std::string& type) {
  if (type == "integer") return value.is_number_integer();
  return type == value.type_name();
}

class Check {
 public:
  explicit Check(const json& document) : document_(document) {}

  void walk(const json& schema, const json& value, const std::string& where) {
    for (const auto& [keyword, told] : resolved(document_, schema).items()) {
      const auto rule = kRules.find(keyword);
      if (rule == kRules.end()) {
        found_.push_back(where + " is described by '" + keyword + "', which nothing checks");
      } else {
        (this->*rule->second)(told, value, where);
      }
    }
  }
  std::vector<std::string> found() && { return std::move(found_); }

 private:
  using Rule = void (Check::*)(const json& told, const json& value, const std::string& where);
  static const std::map<std::string, Rule> kRules;

  void expect(bool right, const std::string& where, const std::string& breach, const json& told) {
    if (!right) found_.push_back(where + breach + told.dump());
  }
  void nothing(const json& /*told*/, const json& /*value*/, const std::string& /*where*/) {}
  void type(const json& told, const json& value, const std::string& where) {
    const json types = told.is_array() ? told : json::array({told});
    const bool right = std::ranges::any_of(types, [&](const json& type) { return is_of_type(value, type); });
    expect(right, where, " is " + std::string(value.type_name()) + " and no ", told);
  }
  void one_of(const json& told, const json& value, const std::string& where) {
    expect(std::ranges::find(told, value) != told.end(), where, " is none of ", told);
  }
  void constant(const json& told, const json& value, const std::string& where) {
    expect(value == told, where, " is not ", told);
  }
  void minimum(const json& told, const json& value, const std::string& where) {
    expect(!value.is_number() || value >= told, where, " is below ", told);
  }
  void maximum(const json& told, const json& value, const std::string& where) {
    expect(!value.is_number() || value <= told, where, " is above ", told);
  }
  void exclusive_minimum(const json& told, const json& value, const std::string& where) {
    expect(!value.is_number() || value > told, where, " is not above ", told);
  }
  void exclusive_maximum(const json& told, const json& value, const std::string& where) {
    expect(!value.is_number() || value < told, where, " is not below ", told);
  }
  void min_items(const json& told, const json& value, const std::string& where) {
    expect(!value.is_array() || json(value.size()) >= told, where, " has fewer items than ", told);
  }
  void max_items(const json& told, const json& value, const std::string& where) {
    expect(!value.is_array() || json(value.size()) <= told, where, " has more items than ", told);
  }
  void required(const json& told, const json& value, const std::string& where) {
    for (const json& name : told) {
      expect(!value.is_object() || value.contains(name.get<std::string>()), where, " lacks ", name);
    }
  }
  void properties(const json& told, const json& value, const std::string& where) {
    if (!value.is_object()) return;
    for (const auto& [name, member] : value.items()) {
      const std::string at = where + "." + name;
      if (told.contains(name)) {
        walk(told[name], member, at);
      } else {
        found_.push_back(at + " is not described");
      }
    }
  }
  void items(const json& told, const json& value, const std::string& where) {
    if (!value.is_array()) return;
    for (std::size_t i = 0; i < value.size(); ++i) walk(told, value[i], where + "[" + std::to_string(i) + "]");
  }

  const json& document_;
  std::vector<std::string> found_;
};

const std::map<std::string, Check::Rule> Check::kRules{
    {"type", &Check::type},
    {"enum", &Check::one_of},
    {"const", &Check::constant},
    {"minimum", &Check::minimum},
    {"maximum", &Check::maximum},
    {"exclusiveMinimum", &Check::exclusive_minimum},
    {"exclusiveMaximum", &Check::exclusive_maximum},
    {"minItems", &Check::min_items},
    {"maxItems", &Check::max_items},
    {"required", &Check::required},
    {"properties", &Check::properties},
    {"items", &Check::items},
    {"additionalProperties", &Check::nothing},  // false, as `properties` has it anyway
    {"contentEncoding", &Check::nothing},
    {"default", &Check::nothing},
    {"description", &Check::nothing},
    {"format", &Check::nothing},
};

}  // namespace

const json& resolved(const json& document, const json& node) {
  if (!node.contains("$ref")) return node;
  return document.at(json::json_pointer(node["$ref"].get<std::string>().substr(1)));
}

std::vector<std::string> breaches(const json& document, const json& schema, const json& value) {
  Check check(document);
  check.walk(schema, value, "$");
  return std::move(check).found();
}

}  // namespace roadfix::testing
