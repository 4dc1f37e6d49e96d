#include "server/http/errors.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/units/text.hpp"

namespace roadfix::http {
namespace {

/// Longer than all names of fields that there are; those that clients make up may have megabytes.
constexpr std::size_t kLongestField = 100;

}  // namespace

MethodNotAllowed::MethodNotAllowed(const std::string& method, std::string allowed)
    : InvalidInput("method-not-allowed", fmt::format("{} is not possible here; allowed: {}", method, allowed)),
      allowed_(std::move(allowed)) {}

InvalidField::InvalidField(std::string code, const std::string& field, const std::string& message,
                           std::optional<std::size_t> byte)
    : InvalidInput(std::move(code), message), field_(shortened(field, kLongestField)), byte_(byte) {}

InvalidField given_twice(const std::string& name) {
  return {"duplicate-parameter", name, fmt::format("'{}' is given twice", shortened(name, kLongestField))};
}

ClientGone::ClientGone() : Interrupted("client-gone", "the client hung up before its answer was ready") {}

Busy::Busy(const std::string& message, std::chrono::seconds retry_after)
    : Interrupted("server-busy", message), retry_after_(retry_after) {}

}  // namespace roadfix::http
