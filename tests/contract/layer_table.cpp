#include "tests/contract/layer_table.hpp"

#include <algorithm>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace roadfix::testing {
namespace {

using Row = std::vector<std::string>;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Cells of a line "| a | b |", empty for any other line.
Row cells_of(const std::string& line) {
  if (line.size() < 2 || line.front() != '|' || line.back() != '|') return {};
  Row cells;
  std::istringstream in(line.substr(1));
  for (std::string cell; std::getline(in, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

/// Rows below the header that starts with the given column.
std::vector<Row> rows_of_table(std::string_view markdown, std::string_view first_column) {
  std::vector<Row> rows;
  bool inside = false;
  std::istringstream in{std::string(markdown)};
  for (std::string line; std::getline(in, line);) {
    const Row cells = cells_of(line);
    if (cells.empty()) {
      inside = false;
    } else if (cells.front() == first_column) {
      inside = true;
    } else if (inside && !cells.front().starts_with("-")) {
      rows.push_back(cells);
    }
  }
  if (rows.empty()) throw std::runtime_error("no table with the column " + std::string(first_column));
  return rows;
}

std::vector<std::string> list_of(const std::string& cell) {
  std::vector<std::string> names;
  std::istringstream in(cell);
  for (std::string name; std::getline(in, name, ',');) {
    std::erase(name, '`');
    names.push_back(trimmed(name));
  }
  return names;
}

bool is_folder_of(std::string_view folder, std::string_view path) {
  return path.starts_with(folder) && (path.size() == folder.size() || path[folder.size()] == '/');
}

using Uses = std::map<std::string, std::set<std::string>>;

/// Everything reachable from the module. `path` holds the modules on the way, to notice a circle.
std::set<std::string> reachable(const Uses& direct, const std::string& module, std::set<std::string> path = {}) {
  if (!path.insert(module).second) throw std::runtime_error(module + " uses itself in a circle");
  std::set<std::string> all;
  for (const auto& used : direct.at(module)) {
    all.insert(used);
    all.merge(reachable(direct, used, path));
  }
  return all;
}

std::optional<std::string> library_of(const LayerTable& table, std::string_view header) {
  for (const auto& [library, prefixes] : table.header_prefixes) {
    if (std::ranges::any_of(prefixes, [&](const auto& prefix) { return header.starts_with(prefix); })) return library;
  }
  return std::nullopt;
}

bool is_standard(std::string_view header) { return header.find_first_of("./") == std::string_view::npos; }

}  // namespace

std::optional<std::string> LayerTable::module_of(std::string_view path) const {
  std::optional<std::string> best;
  for (const auto& [folder, module] : modules) {
    if (is_folder_of(folder, path) && (!best || folder.size() > best->size())) best = folder;
  }
  return best;
}

LayerTable parse_layer_table(std::string_view markdown) {
  LayerTable table;
  for (const Row& row : rows_of_table(markdown, "Library")) table.header_prefixes[row.at(0)] = list_of(row.at(1));
  const std::vector<Row> rows = rows_of_table(markdown, "Module");
  Uses direct;
  for (const Row& row : rows) direct[list_of(row.at(0)).at(0)];
  for (const Row& row : rows) {
    const std::string module = list_of(row.at(0)).at(0);
    for (const auto& used : list_of(row.at(2))) {
      const auto before = direct[module].size();
      for (const auto& [other, ignored] : direct) {
        if (other != module && is_folder_of(used, other)) direct[module].insert(other);
      }
      if (direct[module].size() == before) throw std::runtime_error(module + " uses the unknown module " + used);
    }
    for (const auto& library : list_of(row.at(3))) {
      if (!table.header_prefixes.contains(library)) throw std::runtime_error("no row for the library " + library);
      table.modules[module].libraries.insert(library);
    }
  }
  for (const auto& [module, ignored] : direct) table.modules[module].uses = reachable(direct, module);
  return table;
}

std::vector<std::string> forbidden_includes(const LayerTable& table, std::string_view path, std::string_view source) {
  const auto module = table.module_of(path);
  if (!module) return {std::string(path) + ": no row of the module table covers this file"};
  const auto& allowed = table.modules.at(*module);
  std::vector<std::string> complaints;
  static const std::regex include(R"re((?:^|\n)\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  const std::string text(source);
  for (auto it = std::sregex_iterator(text.begin(), text.end(), include); it != std::sregex_iterator(); ++it) {
    const std::string header = (*it)[1];
    if (const auto used = table.module_of(header)) {
      if (*used == *module || allowed.uses.contains(*used)) continue;
    } else if (const auto library = library_of(table, header)) {
      if (allowed.libraries.contains(*library)) continue;
    } else if (is_standard(header)) {
      continue;
    }
    complaints.push_back(std::string(path) + " includes " + header + ", which the row of " + *module +
                         " does not allow");
  }
  return complaints;
}

}  // namespace roadfix::testing
