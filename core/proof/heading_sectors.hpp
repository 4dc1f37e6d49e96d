// The headings of a proof: the feature map turned to each, and what sectors of neighbouring headings cover of the map.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/proof/bound_problem.hpp"
#include "core/proof/bound_sums.hpp"
#include "core/proof/ground_sums.hpp"
#include "core/proof/score_bound.hpp"

namespace roadfix {

/// Neighbouring headings, first <= heading < end, with the blocks that all (inner) and any (outer) of them cover.
struct Sector {
  std::size_t first = 0;
  std::size_t end = 0;
  std::vector<RowRun> inner, outer;
  double outer_blocks = 0.0;
  BlockSums features;  ///< bounds that hold for all of them; map sums are not set
};

/// Sums of the map under the inner and outer blocks of a sector, for a run of blocks.
struct SectorRun {
  CoveredSums inner, outer;
};

/// Sums of a feature map over those of its cells where the map is observed.
struct PartialFeatures {
  double sum_min = 0.0, sum_max = 0.0, square_min = 0.0;
};

/// Replaces what holds for a sector by what holds for one of its headings: if all of the map under the footprint is
/// observed, and if parts of it are not.
void narrow(BlockSums& sums, const TurnedFeatures& turned);
void narrow(BlockSums& sums, const TurnedFeatures& turned, const PartialFeatures& observed);
/// Replaces the map's sums under the footprints of a sector by those under the footprint of one heading.
void narrow(BlockSums& sums, const TurnedFeatures& turned, const GroundRange& ground);

class HeadingSectors {
 public:
  explicit HeadingSectors(const BoundProblem& problem) : problem_(problem) {}
  /// Turns the feature map to all headings. False if time ran out.
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
