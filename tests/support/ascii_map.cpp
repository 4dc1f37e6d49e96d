#include "tests/support/ascii_map.hpp"

#include <sstream>
#include <stdexcept>
#include <vector>

namespace roadfix::testing {
namespace {

Cell cell_of(char c) {
  if (c == '#') return kRoad;
  if (c == '.') return kNoRoad;
  if (c == '?') return kUnobserved;
  if (c >= '0' && c <= '9') return cell_from_probability((c - '0') / 10.0);
  throw std::invalid_argument(std::string("no cell is drawn as ") + c);
}

char char_of(Cell cell) {
  if (cell == kUnobserved) return '?';
  if (cell == kRoad) return '#';
  if (cell == kNoRoad) return '.';
  return static_cast<char>('0' + static_cast<int>(probability(cell) * 10.0));
}

}  // namespace

CellArray from_ascii(std::string_view picture) {
  std::vector<std::string> lines;
  std::istringstream in{std::string(picture)};
  for (std::string line; in >> line;) lines.push_back(line);
  if (lines.empty()) return {};
  CellArray cells(static_cast<int>(lines.front().size()), static_cast<int>(lines.size()));
  for (int row = 0; row < cells.rows(); ++row) {
    const std::string& line = lines[static_cast<std::size_t>(row)];
    if (line.size() != lines.front().size()) throw std::invalid_argument("lines of a map must be equally long");
    for (int col = 0; col < cells.cols(); ++col) cells.at(col, row) = cell_of(line[static_cast<std::size_t>(col)]);
  }
  return cells;
}

std::string to_ascii(const CellArray& cells) {
  std::string picture;
  for (int row = 0; row < cells.rows(); ++row) {
    for (const Cell cell : cells.row(row)) picture += char_of(cell);
    picture += '\n';
  }
  return picture;
}

}  // namespace roadfix::testing
