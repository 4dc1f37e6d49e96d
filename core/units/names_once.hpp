// Reads JSON and refuses a name that an object has twice. One of the two values is a mistake, and nothing tells which;
// the library would keep the last one.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roadfix {

/// What nlohmann::json tells of a text while it reads it, put together. Its own parser can call back for each name, but
/// then looks through the whole of an array after each object in it: a hundred thousand poses took two seconds.
template <typename Refuse>
class NamesOnce {
 public:
  using Json = nlohmann::json;

  explicit NamesOnce(Refuse refuse) : refuse_(std::move(refuse)) {}
  Json take() { return std::move(root_); }

  bool null() { return put(nullptr); }
  bool boolean(bool value) { return put(value); }
  bool number_integer(Json::number_integer_t value) { return put(value); }
  bool number_unsigned(Json::number_unsigned_t value) { return put(value); }
  bool number_float(Json::number_float_t value, const std::string& /*text*/) { return put(value); }
  bool string(std::string& value) { return put(std::move(value)); }
  bool binary(Json::binary_t& value) { return put(std::move(value)); }
  bool start_object(std::size_t /*size*/) { return open(Json::object()); }
  bool start_array(std::size_t /*size*/) { return open(Json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    const auto [member, is_first] = open_.back()->template get_ref<Json::object_t&>().try_emplace(std::move(name));
    if (!is_first) refuse_(member->first);
    member_ = &member->second;
    return true;
  }
  template <typename Error>
  bool parse_error(std::size_t /*byte*/, const std::string& /*token*/, const Error& error) {
    throw error;
  }

 private:
  Json& add(Json value) {
    if (open_.empty()) return root_ = std::move(value);
    if (open_.back()->is_object()) return *member_ = std::move(value);
    return open_.back()->emplace_back(std::move(value));
  }
  bool put(Json value) {
    add(std::move(value));
    return true;
  }
  bool open(Json value) {
    open_.push_back(&add(std::move(value)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  Refuse refuse_;
  Json root_;
  Json* member_ = nullptr;   ///< whose name was read last
  std::vector<Json*> open_;  ///< arrays and objects, outermost first
};

/// Throws what nlohmann::json::parse throws; calls `refuse`, which throws, with a name that comes a second time.
template <typename Refuse>
nlohmann::json parse_with_names_once(std::string_view text, Refuse refuse) {
  NamesOnce<Refuse> json(std::move(refuse));
  nlohmann::json::sax_parse(text, &json);
  return json.take();
}

}  // namespace roadfix
