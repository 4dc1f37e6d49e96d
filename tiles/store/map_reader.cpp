#include "tiles/store/map_reader.hpp"
