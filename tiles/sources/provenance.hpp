// What is told of a source beside its cells.
#pragma once

#include <string>

namespace roadfix {

/// Empty and 0 where nothing is told.
struct Provenance {
  std::string date = {};  ///< of the content, ISO 8601
  std::string licence = {};
  std::string attribution = {};
  double registration_sigma_m = 0.0;

  friend bool operator==(const Provenance&, const Provenance&) = default;
};

}  // namespace roadfix
