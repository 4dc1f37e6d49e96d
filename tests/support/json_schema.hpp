// Whether JSON is as schema/openapi.json describes it: what that uses of JSON Schema (2020-12).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace roadfix::testing {

/// What `node` refers to in the document, or `node`.
const nlohmann::json& resolved(const nlohmann::json& document, const nlohmann::json& node);

/// What of `value` is not as `schema` says, and where: "$.poses[2].lat is no number". A member that is not described is
/// wrong, unless none is; and so is a keyword of the schema that is not known here.
std::vector<std::string> breaches(const nlohmann::json& document, const nlohmann::json& schema,
                                  const nlohmann::json& value);

}  // namespace roadfix::testing
