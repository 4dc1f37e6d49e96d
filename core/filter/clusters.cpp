#include "core/filter/clusters.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace roadfix {
namespace {

// Particles in bins that touch belong together.
constexpr double kClusterBinM = 20.0;
constexpr std::int64_t kTurnBins = 24;

using CoarseBin = std::array<std::int64_t, 3>;

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

struct Binning {
  std::vector<CoarseBin> bins;      ///< sorted, distinct
  std::vector<std::size_t> bin_of;  ///< for each of the particles with weight
};

Binning binned(const Particles& particles, const std::vector<std::size_t>& members) {
  std::vector<CoarseBin> of_member;
  for (const std::size_t i : members) {
    const double turned = Angle::radians(particles.heading_rad[i]).compass_degrees() / 360.0;
    of_member.push_back({static_cast<std::int64_t>(std::floor(particles.east_m[i] / kClusterBinM)),
                         static_cast<std::int64_t>(std::floor(particles.north_m[i] / kClusterBinM)),
                         static_cast<std::int64_t>(turned * static_cast<double>(kTurnBins)) % kTurnBins});
  }
  Binning result{of_member, {}};
  std::ranges::sort(result.bins);
  result.bins.erase(std::unique(result.bins.begin(), result.bins.end()), result.bins.end());
  for (const CoarseBin& bin : of_member) {
    result.bin_of.push_back(static_cast<std::size_t>(std::ranges::lower_bound(result.bins, bin) - result.bins.begin()));
  }
  return result;
}

/// Joins each bin with those of its 26 neighbours that hold particles; headings go round.
UnionFind joined(const std::vector<CoarseBin>& bins) {
  UnionFind groups(bins.size());
  for (std::size_t i = 0; i < bins.size(); ++i) {
    for (int k = 0; k < 27; ++k) {
      const CoarseBin near{bins[i][0] + k % 3 - 1, bins[i][1] + k / 3 % 3 - 1,
                           (bins[i][2] + k / 9 - 1 + kTurnBins) % kTurnBins};
      const auto found = std::ranges::lower_bound(bins, near);
      if (found != bins.end() && *found == near) groups.join(i, static_cast<std::size_t>(found - bins.begin()));
    }
  }
  return groups;
}

Cluster summary(const Particles& p, const std::vector<std::size_t>& members) {
  Cluster cluster;
  double sine = 0.0;
  double cosine = 0.0;
  for (const std::size_t i : members) {
    const double w = p.weight[i];
    cluster.weight += w;
    cluster.mean.position.east_m += w * p.east_m[i];
    cluster.mean.position.north_m += w * p.north_m[i];
    sine += w * std::sin(p.heading_rad[i]);
    cosine += w * std::cos(p.heading_rad[i]);
    cluster.log_scale += w * p.log_scale[i];
  }
  cluster.mean.position.east_m /= cluster.weight;
  cluster.mean.position.north_m /= cluster.weight;
  cluster.log_scale /= cluster.weight;
  cluster.mean.heading = Angle::radians(std::atan2(sine, cosine));
  double scale_variance = 0.0;
  std::vector<std::pair<double, double>> distances;
  for (const std::size_t i : members) {
    const std::array<double, 3> off{p.east_m[i] - cluster.mean.position.east_m,
                                    p.north_m[i] - cluster.mean.position.north_m,
                                    (Angle::radians(p.heading_rad[i]) - cluster.mean.heading).wrapped().radians()};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) cluster.covariance[a][b] += p.weight[i] / cluster.weight * off[a] * off[b];
    }
    scale_variance += p.weight[i] / cluster.weight * std::pow(p.log_scale[i] - cluster.log_scale, 2.0);
    distances.emplace_back(std::hypot(off[0], off[1]), p.weight[i]);
  }
  cluster.log_scale_sigma = std::sqrt(scale_variance);
  std::ranges::sort(distances);
  double within = 0.0;
  for (const auto& [distance, weight] : distances) {
    cluster.radius95_m = distance;
    within += weight;
    if (within >= 0.95 * cluster.weight) break;
  }
  cluster.weight = std::min(cluster.weight, 1.0);  // the sum may round beyond it
  return cluster;
}

/// Of the particles with weight those that hang together; none is empty.
std::vector<std::vector<std::size_t>> groups_of(const Particles& particles) {
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.weight[i] > 0.0) members.push_back(i);
  }
  const Binning binning = binned(particles, members);
  UnionFind joined_bins = joined(binning.bins);
  std::vector<std::vector<std::size_t>> groups(binning.bins.size());
  for (std::size_t m = 0; m < members.size(); ++m) groups[joined_bins.root(binning.bin_of[m])].push_back(members[m]);
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

}  // namespace

double Cluster::sigma_m() const { return std::sqrt(largest_variance_m2(covariance)); }

std::vector<Cluster> clusters_of(const Particles& particles) {
  std::vector<Cluster> clusters;
  for (const auto& group : groups_of(particles)) clusters.push_back(summary(particles, group));
  std::ranges::stable_sort(clusters, std::ranges::greater{}, &Cluster::weight);
  return clusters;
}

Cluster heaviest_of(const Particles& particles) {
  const auto groups = groups_of(particles);
  assert(!groups.empty());
  const auto weight = [&](const std::vector<std::size_t>& group) {
    return std::accumulate(group.begin(), group.end(), 0.0,
                           [&](double sum, std::size_t i) { return sum + particles.weight[i]; });
  };
  return summary(particles, *std::ranges::max_element(groups, {}, weight));
}

}  // namespace roadfix
