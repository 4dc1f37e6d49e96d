// What is told of a source of a map beside its cells.
#pragma once

#include <span>
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

/// What the licences ask to be shown beside the content: "attribution (licence)", each once and separated by "; ".
std::string credits_of(std::span<const Provenance> parts);

/// Of what is made of all these: the oldest date, the largest registration error, the licence where it is the same for
/// all that are credited, and all attributions. Where licences differ, the attribution has all credits.
Provenance combined(std::span<const Provenance> parts);

}  // namespace roadfix
