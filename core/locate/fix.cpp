#include "core/locate/fix.hpp"
