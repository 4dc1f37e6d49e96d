// The two tables of ARCHITECTURE.md in typed form: which module may use which, and where a library may be included.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace roadfix::testing {

struct LayerTable {
  struct Module {
    std::set<std::string> uses;       ///< modules, everything reachable included
    std::set<std::string> libraries;  ///< names as in `header_prefixes`
  };
  std::map<std::string, Module> modules;                            ///< by folder
  std::map<std::string, std::vector<std::string>> header_prefixes;  ///< by library

  /// The module whose folder is the longest beginning of `path`; nullopt where no row covers it.
  std::optional<std::string> module_of(std::string_view path) const;
};

/// Throws std::runtime_error for rows that name unknown modules or libraries, or that use each other in a circle.
LayerTable parse_layer_table(std::string_view markdown);

/// One line per include of the file that the table does not allow. `path` is relative to the project.
std::vector<std::string> forbidden_includes(const LayerTable& table, std::string_view path, std::string_view source);

}  // namespace roadfix::testing
