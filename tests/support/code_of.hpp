// The stable code of the error that a call throws, and its message.
#pragma once

#include <string>

#include "core/units/error.hpp"

namespace roadfix::testing {

std::string code_of(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.code();
  }
  return "no error";
}

std::string message_of(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace roadfix::testing
