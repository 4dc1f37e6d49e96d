// What ends exports of any format. Not for other modules.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "core/units/error.hpp"

namespace roadfix {

inline IoFailure cannot_be_written(const std::filesystem::path& target, const std::string& reason) {
  return {"export-failed",
          fmt::format("{}: it cannot be written ({}). Check that the folder exists, may be written to and has room",
                      target.string(), reason)};
}

inline Interrupted export_stopped() { return {"work-stopped", "the export was stopped; nothing was written"}; }

}  // namespace roadfix
