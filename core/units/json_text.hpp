// JSON as it is handed out: answers of the service, and what commands print.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace roadfix {

/// On one line, or with so many blanks a level. What is no UTF-8, as a name of a file may be, is replaced: an answer is
/// not lost for it.
std::string json_text(const nlohmann::json& json, int indent = -1);

}  // namespace roadfix
