#include "core/units/error.hpp"

#include <utility>

namespace roadfix {

Error::Error(std::string code, const std::string& message) : std::runtime_error(message), code_(std::move(code)) {}

}  // namespace roadfix
