#include "tiles/pipeline/describe_source.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>

namespace roadfix {
namespace {

struct Text {
  const char* name;
  const char* option;
  std::string Provenance::*text;
  std::optional<std::string> UserProvenance::*told;
};

constexpr std::array<Text, 3> kTexts{
    {{"date", "--date", &Provenance::date, &UserProvenance::date},
     {"licence", "--licence", &Provenance::licence, &UserProvenance::licence},
     {"attribution", "--attribution", &Provenance::attribution, &UserProvenance::attribution}}};

void tell(Provenance& provenance, const UserProvenance& told) {
  for (const Text& each : kTexts) {
    if (const auto& said = told.*each.told) provenance.*each.text = *said;
  }
  if (told.registration_sigma_m) provenance.registration_sigma_m = *told.registration_sigma_m;
}

std::string shown(const std::string& text) { return text.empty() ? "none" : "'" + text + "'"; }

/// On what is taken from the source itself.
std::optional<std::string> note_on_own(const std::string& location, const Provenance& own, const UserProvenance& told) {
  std::vector<std::string> facts;
  std::vector<std::string> options;
  for (const auto& [name, option, text, of_user] : kTexts) {
    if ((own.*text).empty() || told.*of_user) continue;
    facts.push_back(fmt::format("{} {}", name, shown(own.*text)));
    options.emplace_back(option);
  }
  if (own.registration_sigma_m > 0.0 && !told.registration_sigma_m) {
    facts.push_back(fmt::format("position within {:.3g} m (1 sigma)", own.registration_sigma_m));
    options.emplace_back("--registration-sigma");
  }
  if (facts.empty()) return std::nullopt;
  return fmt::format("{} says of itself: {}. That is taken over; {} would say otherwise", location,
                     fmt::join(facts, ", "), fmt::join(options, ", "));
}

/// Something that differs from what was told before.
struct Change {
  const char* option;
  std::string text;
  bool asked_for;
};

std::vector<Change> changes_of(const Provenance& before, const Provenance& now, const UserProvenance& told) {
  std::vector<Change> changes;
  for (const auto& [name, option, text, of_user] : kTexts) {
    if (before.*text == now.*text) continue;
    changes.push_back({option, fmt::format("{} {} instead of {}", name, shown(now.*text), shown(before.*text)),
                       (told.*of_user).has_value()});
  }
  if (before.registration_sigma_m != now.registration_sigma_m) {
    changes.push_back({"--registration-sigma",
                       fmt::format("position within {:.3g} m instead of {:.3g} m (1 sigma)", now.registration_sigma_m,
                                   before.registration_sigma_m),
                       told.registration_sigma_m.has_value()});
  }
  return changes;
}

}  // namespace

std::vector<std::string> describe_source(SourceRecord& record, const Provenance& own, const UserProvenance& told,
                                         std::span<const SourceRecord> before, bool replace) {
  const auto same = std::ranges::find(before, record.fingerprint, &SourceRecord::fingerprint);
  const bool goes_on = same != before.end() && !replace;
  std::vector<std::string> notes;
  if (goes_on) {
    record.provenance = same->provenance;
  } else {
    for (const Text& each : kTexts) record.provenance.*each.text = own.*each.text;
    if (auto note = note_on_own(record.location, own, told)) notes.push_back(std::move(*note));
  }
  tell(record.provenance, told);
  if (!goes_on && (!replace || before.empty())) return notes;
  const Provenance& old = goes_on ? same->provenance : before.front().provenance;
  for (const auto& [option, text, asked_for] : changes_of(old, record.provenance, told)) {
    notes.push_back(asked_for ? fmt::format("'{}' now has {}", record.name, text)
                              : fmt::format("--replace describes '{}' anew: {}. Where the old still holds, repeat this "
                                            "with {}",
                                            record.name, text, option));
  }
  return notes;
}

}  // namespace roadfix
