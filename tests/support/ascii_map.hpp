// Maps drawn in the test: '#' road, '.' no road, '?' unobserved, '0'..'9' probability in tenths.
#pragma once

#include <string>
#include <string_view>

#include "core/grid/cell_array.hpp"

namespace roadfix::testing {

/// Lines of equal length; leading and trailing white space of each line and empty lines are ignored.
CellArray from_ascii(std::string_view picture);
std::string to_ascii(const CellArray& cells);

}  // namespace roadfix::testing
