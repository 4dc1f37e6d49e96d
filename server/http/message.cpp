#include "server/http/message.hpp"

#include <string_view>

#include "core/units/text.hpp"

namespace roadfix::http {

const std::string& Request::header(const std::string& lower_case_name) const {
  static const std::string kAbsent;
  const auto found = headers.find(lower_case_name);
  return found == headers.end() ? kAbsent : found->second;
}

std::string Request::media_type() const {
  const std::string_view value = header("content-type");
  return lower_case(trimmed(value.substr(0, value.find(';'))));
}

}  // namespace roadfix::http
