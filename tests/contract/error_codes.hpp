// The codes of errors as the sources name them, found without compiling: string literals, and the class that each is
// thrown as.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace roadfix::testing {

struct ErrorCodes {
  /// Every literal of several words in lower case with hyphens between them ("map-not-found"), by the files that hold
  /// it. A code that reaches an error by a helper, a constant or a table is among them.
  std::map<std::string, std::set<std::string>> words;
  /// The classes that such a literal is thrown as, where the error is made in the expression that holds it.
  std::map<std::string, std::set<std::string>> classes;
  /// Errors whose code is put together, or whose literal is no such word: nothing here or there could list it.
  std::vector<std::string> complaints;
};

/// Adds what one source says. `classes` are the names of the hierarchy of core/units/error.hpp. Comments say nothing,
/// and entries of the table from codes to HTTP status ({"map-not-found", 404}) throw nothing.
void add_error_codes(ErrorCodes& codes, const std::set<std::string>& classes, const std::string& path,
                     std::string_view source);

/// The classes of the sources that are or derive from Error, and are made with a code as their first argument.
std::set<std::string> error_classes(const std::vector<std::string>& sources);

}  // namespace roadfix::testing
