#include "server/http/message.hpp"

#include <algorithm>

namespace roadfix::http {

const std::string& Request::header(const std::string& lower_case_name) const {
  static const std::string kAbsent;
  const auto found = headers.find(lower_case_name);
  return found == headers.end() ? kAbsent : found->second;
}

std::string Request::media_type() const {
  const std::string& value = header("content-type");
  std::string type = value.substr(0, value.find(';'));
  while (!type.empty() && (type.back() == ' ' || type.back() == '\t')) type.pop_back();
  std::ranges::transform(type, type.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return type;
}

}  // namespace roadfix::http
