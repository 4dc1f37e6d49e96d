#include "cli/output_file.hpp"

#include <fmt/format.h>

#include <fstream>

#include "core/units/error.hpp"

namespace roadfix::cli {

void write_file(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) {
    throw IoFailure("result-unwritable",
                    fmt::format("{} cannot be written: check that its folder exists, may be written to, and is not "
                                "full",
                                file.string()));
  }
}

}  // namespace roadfix::cli
