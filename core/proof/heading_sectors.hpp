// The headings of a proof: the feature map turned to each, and what neighbouring headings cover of the map together.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/proof/bound_problem.hpp"
#include "core/proof/bound_sums.hpp"
#include "core/proof/ground_sums.hpp"
#include "core/proof/score_bound.hpp"

namespace roadfix {

/// Headings beside each other, first <= heading < end, and what any or all of them cover.
struct Sector {
  std::size_t first = 0;
  std::size_t end = 0;
  std::vector<RowRun> inner, outer;
  double outer_blocks = 0.0;
  BlockSums features;  ///< what holds for all of them; map sums are left out
};

/// What the map holds under all and under any of a sector's headings, for a run of blocks.
struct SectorRun {
  CoveredSums inner, outer;
};

/// Sums of a feature map over those of its cells where the map is observed.
struct PartialFeatures {
  double sum_min = 0.0, sum_max = 0.0, square_min = 0.0;
};

/// Puts what holds for one heading in place of what holds for its sector: where all of the map under the footprint is
/// observed, and where parts of it are not.
void narrow(BlockSums& sums, const TurnedFeatures& turned);
void narrow(BlockSums& sums, const TurnedFeatures& turned, const PartialFeatures& observed);
/// Puts what the map holds under a heading's footprint in place of what it holds under those of its sector.
void narrow(BlockSums& sums, const TurnedFeatures& turned, const GroundRange& ground);

class HeadingSectors {
 public:
  explicit HeadingSectors(const BoundProblem& problem) : problem_(problem) {}
  /// False if time was over before all were turned.
  bool turn(const Deadline& deadline);

  const std::vector<Sector>& sectors() const { return sectors_; }
  const Sector& sector_of(std::size_t heading) const { return sectors_[heading / kSectorHeadings]; }
  const TurnedFeatures& turned(std::size_t heading) const { return *turned_[heading]; }

  struct Covered {
    BlockSums sums;             ///< for all headings of the sector
    bool map_observed = false;  ///< all of it under the footprint, from every position of the block
  };
  static Covered covered(const Sector& sector, const SectorRun& run, std::size_t block);

 private:
  static constexpr std::size_t kSectorHeadings = 4;  // share what they cover of the map

  Sector sector_between(std::size_t first, std::size_t end) const;

  const BoundProblem& problem_;
  std::vector<std::optional<TurnedFeatures>> turned_;
  std::vector<Sector> sectors_;
};

}  // namespace roadfix
