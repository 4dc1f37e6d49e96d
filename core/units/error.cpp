#include "core/units/error.hpp"

#include <cassert>
#include <utility>

namespace roadfix {

Error::Error(std::string code, const std::string& message) : std::runtime_error(message), code_(std::move(code)) {
  assert(code_.find('-') != std::string::npos);
}

bool is_about_input(const Error& error) {
  return dynamic_cast<const InvalidInput*>(&error) != nullptr || dynamic_cast<const NotFound*>(&error) != nullptr ||
         dynamic_cast<const LimitExceeded*>(&error) != nullptr;
}

}  // namespace roadfix
