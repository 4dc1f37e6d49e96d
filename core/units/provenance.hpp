// What is told of a source of a map beside its cells.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "core/units/words.hpp"

namespace roadfix {

/// Pictures in which roads are found, or roads as data.
enum class SourceContent { kImagery, kRoads };

/// As maps, requests and answers name it.
inline constexpr std::array<Word<SourceContent>, 2> kSourceContents{
    {{"imagery", SourceContent::kImagery}, {"roads", SourceContent::kRoads}}};
constexpr std::string_view to_string(SourceContent content) { return word_of(kSourceContents, content); }

/// Empty and 0 where nothing is told.
struct Provenance {
  std::string date = {};  ///< of the content, ISO 8601
  std::string licence = {};
  std::string attribution = {};
  double registration_sigma_m = 0.0;

  friend bool operator==(const Provenance&, const Provenance&) = default;
};

/// How the cells of a source of imagery were made: by which detector (RoadDetector::describe()), and what else changes
/// them. Maps keep it: detector_in() has to read what has been written.
std::string method_by(std::string_view detector, std::string_view settings);
/// The detector that method_by() was told.
std::string_view detector_in(std::string_view method);

/// What the licences ask to be shown beside the content: "attribution (licence)", each once and separated by "; ".
std::string credits_of(std::span<const Provenance> parts);

/// Of what is made of all these: the oldest date, the largest registration error, the licence where it is the same for
/// all that are credited, and all attributions. Where licences differ, the attribution has all credits.
Provenance combined(std::span<const Provenance> parts);

}  // namespace roadfix
