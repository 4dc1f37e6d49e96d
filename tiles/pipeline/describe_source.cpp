#include "tiles/pipeline/describe_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace roadfix {
namespace {

struct Text {
  const char* name;
  const char* option;
  std::string SourceRecord::*of_record;
  std::string Provenance::*told;
};

constexpr std::array<Text, 3> kTexts{
    {{"date", "--date", &SourceRecord::date, &Provenance::date},
     {"licence", "--licence", &SourceRecord::licence, &Provenance::licence},
     {"attribution", "--attribution", &SourceRecord::attribution, &Provenance::attribution}}};

void keep(SourceRecord& record, const SourceRecord& before) {
  for (const Text& text : kTexts) record.*text.of_record = before.*text.of_record;
  record.registration_sigma_m = before.registration_sigma_m;
}

void tell(SourceRecord& record, const Provenance& told) {
  for (const Text& text : kTexts) {
    if (!(told.*text.told).empty()) record.*text.of_record = told.*text.told;
  }
  if (told.registration_sigma_m > 0.0) record.registration_sigma_m = told.registration_sigma_m;
}

/// Of something that is told otherwise than before.
struct Change {
  const char* option;
  std::string text;
  bool asked_for;
};

std::vector<Change> changes_of(const SourceRecord& before, const SourceRecord& now, const Provenance& told) {
  std::vector<Change> changes;
  for (const auto& [name, option, of_record, of_user] : kTexts) {
    if (before.*of_record == now.*of_record) continue;
    const auto shown = [](const std::string& value) { return value.empty() ? "none" : "'" + value + "'"; };
    changes.push_back({option,
                       fmt::format("{} {} instead of {}", name, shown(now.*of_record), shown(before.*of_record)),
                       !(told.*of_user).empty()});
  }
  if (before.registration_sigma_m != now.registration_sigma_m) {
    changes.push_back({"--registration-sigma",
                       fmt::format("position within {:.3g} m instead of {:.3g} m (1 sigma)", now.registration_sigma_m,
                                   before.registration_sigma_m),
                       told.registration_sigma_m > 0.0});
  }
  return changes;
}

}  // namespace

std::vector<std::string> describe_source(SourceRecord& record, const Provenance& told,
                                         std::span<const SourceRecord> before, bool replace) {
  const auto same = std::ranges::find(before, record.fingerprint, &SourceRecord::fingerprint);
  const bool goes_on = same != before.end() && !replace;
  if (goes_on) keep(record, *same);
  tell(record, told);
  if (!goes_on && (!replace || before.empty())) return {};
  std::vector<std::string> notes;
  for (const auto& [option, text, asked_for] : changes_of(goes_on ? *same : before.front(), record, told)) {
    notes.push_back(asked_for ? fmt::format("'{}' now has {}", record.name, text)
                              : fmt::format("--replace describes '{}' anew: {}. Where the old still holds, repeat this "
                                            "with {}",
                                            record.name, text, option));
  }
  return notes;
}

}  // namespace roadfix
