#include "tiles/pipeline/witnesses.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "core/grid/cell.hpp"

namespace roadfix {
namespace {

/// An observed cell's probability, without the slight doubt that sources have everywhere: over much ground with few
/// roads it would make up most of the sums.
double road(Cell cell) {
  constexpr double kLeast = 0.1;
  const double p = probability(cell);
  return p < kLeast ? 0.0 : p;
}

/// Over the cells that both sources observed.
struct Sums {
  double n = 0.0;
  double a = 0.0;
  double b = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  double ab = 0.0;
  double lesser = 0.0;  ///< of the smaller one of the two in each cell

  void add(const CellArray& one, const CellArray& other) {
    for (std::size_t i = 0; i < one.cells().size(); ++i) {
      if (!is_observed(one.cells()[i]) || !is_observed(other.cells()[i])) continue;
      const double p = road(one.cells()[i]);
      const double q = road(other.cells()[i]);
      n += 1.0;
      a += p;
      b += q;
      aa += p * p;
      bb += q * q;
      ab += p * q;
      lesser += std::min(p, q);
    }
  }

  /// Pearson's; 0 where either side has no roads.
  double correlation() const {
    const double variances = (n * aa - a * a) * (n * bb - b * b);
    return variances > 0.0 ? (n * ab - a * b) / std::sqrt(variances) : 0.0;
  }
  /// How much of the roads of the source with fewer the other one has in the same cells: 1 for all, 0 for no more than
  /// by chance.
  double contained() const {
    const double fewer = std::min(a, b);
    const double by_chance = a * b;
    const double all = n * fewer;
    return all > by_chance ? (n * lesser - by_chance) / (all - by_chance) : 0.0;
  }
};

}  // namespace

bool is_copy(const SharedEvidence& shared) {
  constexpr double kMinCorrelation = 0.82;
  constexpr double kMinContained = 0.87;
  Sums sums;
  for (const SharedEvidence::Tile& tile : shared.tiles) sums.add(tile.own, tile.others);
  return sums.correlation() >= kMinCorrelation || sums.contained() >= kMinContained;
}

bool Witnesses::are_one(const std::string& one, const std::string& other) {
  const std::pair<std::string, std::string> both = std::minmax(one, other);
  if (const auto known = known_.find(both); known != known_.end()) return known->second;
  const bool copy = is_copy(writer_->shared_evidence(both.first, std::vector<Witness>{{both.second}}, kTilesCompared));
  known_.emplace(both, copy);
  return copy;
}

Witnesses::Around Witnesses::around(const std::string& source) {
  std::vector<Witness> all{{source}};
  for (const std::string& name : writer_->sources_sharing_ground(source)) {
    const auto says_the_same = [&](const Witness& witness) {
      return std::ranges::any_of(witness, [&](const std::string& other) { return are_one(name, other); });
    };
    // It may join several witnesses into one.
    const auto same = std::stable_partition(all.begin(), all.end(), std::not_fn(says_the_same));
    Witness one{name};
    std::for_each(same, all.end(),
                  [&](const Witness& witness) { std::ranges::copy(witness, std::back_inserter(one)); });
    all.erase(same, all.end());
    all.push_back(std::move(one));
  }
  Around result;
  for (Witness& witness : all) {
    std::ranges::sort(witness);
    const auto own = std::ranges::find(witness, source);
    if (own == witness.end()) {
      result.others.push_back(std::move(witness));
    } else {
      witness.erase(own);
      result.copies = std::move(witness);
    }
  }
  return result;
}

}  // namespace roadfix
