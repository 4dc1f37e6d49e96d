#include "core/units/provenance.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

namespace roadfix {
namespace {

/// Each once, in the order given, but for empty ones.
std::string joined(const std::vector<std::string>& texts) {
  std::vector<std::string> seen;
  std::string all;
  for (const std::string& text : texts) {
    if (text.empty() || std::ranges::find(seen, text) != seen.end()) continue;
    seen.push_back(text);
    all += (all.empty() ? "" : "; ") + text;
  }
  return all;
}

std::string credit_of(const Provenance& part) {
  if (part.attribution.empty() || part.licence.empty()) return part.attribution + part.licence;
  return part.attribution + " (" + part.licence + ")";
}

constexpr std::string_view kAfterDetector = "; ";

}  // namespace

std::string method_by(std::string_view detector, std::string_view settings) {
  return std::string(detector).append(kAfterDetector).append(settings);
}

std::string_view detector_in(std::string_view method) { return method.substr(0, method.find(kAfterDetector)); }

std::string credits_of(std::span<const Provenance> parts) {
  std::vector<std::string> credits;
  std::ranges::transform(parts, std::back_inserter(credits), credit_of);
  return joined(credits);
}

Provenance combined(std::span<const Provenance> parts) {
  Provenance all;
  std::vector<std::string> attributions;
  bool one_licence = true;
  for (const Provenance& part : parts) {
    all.registration_sigma_m = std::max(all.registration_sigma_m, part.registration_sigma_m);
    if (!part.date.empty() && (all.date.empty() || part.date < all.date)) all.date = part.date;
    if (credit_of(part).empty()) continue;
    if (attributions.empty()) all.licence = part.licence;
    one_licence = one_licence && part.licence == all.licence;
    attributions.push_back(part.attribution);
  }
  if (!one_licence) all.licence.clear();
  all.attribution = one_licence ? joined(attributions) : credits_of(parts);
  return all;
}

}  // namespace roadfix
