#include "core/units/error.hpp"

#include <cassert>
#include <utility>

namespace roadfix {

Error::Error(std::string code, const std::string& message) : std::runtime_error(message), code_(std::move(code)) {
  assert(code_.find('-') != std::string::npos);
}

}  // namespace roadfix
