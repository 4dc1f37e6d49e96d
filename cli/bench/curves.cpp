#include "cli/bench/curves.hpp"

#include <fmt/format.h>

#include <map>

namespace roadfix::bench {
namespace {

using evaluation::clopper_pearson;
using evaluation::Interval;

constexpr double kSide = 320.0;
constexpr double kMargin = 56.0;
constexpr const char* kBlue = "#1f6fb2";
constexpr const char* kGrey = "#888888";

/// A square of axes from 0 to 1 upwards and from 0 to `right` across.
class Plot {
 public:
  Plot(double right, const std::string& across, const std::string& up) : right_(right) {
    const double size = kSide + 2.0 * kMargin;
    svg_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {0:g}\" font-family=\"sans-serif\" "
        "font-size=\"12\">\n<rect width=\"{0:g}\" height=\"{0:g}\" fill=\"white\"/>\n"
        "<rect x=\"{1:g}\" y=\"{1:g}\" width=\"{2:g}\" height=\"{2:g}\" fill=\"none\" stroke=\"black\"/>\n",
        size, kMargin, kSide);
    text(right / 2.0, -0.13, across);
    text(right / 2.0, 1.05, up);
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      text(-0.06 * right, share - 0.01, fmt::format("{:g}", share));
      text(share * right, -0.06, fmt::format("{:g}", share * right));
    }
  }
  void text(double x, double y, const std::string& words) {
    svg_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", col(x), row(y), words);
  }
  void line(double x0, double y0, double x1, double y1, const char* colour) {
    svg_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", col(x0),
                        row(y0), col(x1), row(y1), colour);
  }
  void point(double x, double y, const Interval& interval, const char* colour) {
    line(x, interval.low, x, interval.high, colour);
    svg_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", col(x), row(y), colour);
  }
  std::string finished() const { return svg_ + "</svg>\n"; }

 private:
  double col(double x) const { return kMargin + kSide * x / right_; }
  double row(double y) const { return kMargin + kSide * (1.0 - y); }

  double right_;
  std::string svg_;
};

struct Share {
  int n = 0;
  int answered = 0;
  int right = 0;
};

bool is_on_map(const SetResult& result) { return result.method == MethodName::kRoads && !result.elsewhere; }

void add(const SetResult& result, Share& share) {
  for (const Outcome& outcome : result.outcomes) {
    ++share.n;
    share.answered += outcome.answer.status == FixStatus::kFix ? 1 : 0;
    share.right += outcome.error_m && *outcome.error_m <= kFalseFixM ? 1 : 0;
  }
}

std::string shares_svg(const std::map<double, Share>& shares, const std::string& across) {
  const double widest = shares.empty() ? 1.0 : 1.2 * shares.rbegin()->first;
  Plot plot(widest, across, "answered (blue), best guess right (grey)");
  for (const auto& [x, share] : shares) {
    const double n = share.n;
    plot.point(x + 0.01 * widest, share.right / n, clopper_pearson(share.right, share.n), kGrey);
    plot.point(x, share.answered / n, clopper_pearson(share.answered, share.n), kBlue);
  }
  return plot.finished();
}

}  // namespace

std::string reliability_svg(const Honesty& honesty) {
  Plot plot(1.0, "probability said", fmt::format("share of right answers, n = {}", honesty.n));
  plot.line(0.0, 0.0, 1.0, 1.0, kGrey);
  for (const ReliabilityBin& bin : honesty.bins) {
    plot.point(bin.mean_probability, static_cast<double>(bin.right) / bin.n, clopper_pearson(bin.right, bin.n), kBlue);
  }
  return plot.finished();
}

std::string answered_svg(std::span<const SetResult> results) {
  std::map<double, Share> shares;
  for (const SetResult& result : results) {
    if (is_on_map(result) && result.footprint_m > 0.0) add(result, shares[result.footprint_m]);
  }
  return shares_svg(shares, "footprint, m");
}

std::optional<std::string> degraded_svg(std::span<const SetResult> results, double FeatureQuality::*property,
                                        const std::string& name) {
  std::map<double, Share> shares;
  for (const SetResult& result : results) {
    if (!is_on_map(result) || !result.quality) continue;
    FeatureQuality others = *result.quality;
    others.*property = 0.0;
    if (others == FeatureQuality{}) add(result, shares[(*result.quality).*property]);
  }
  if (shares.size() < 2) return std::nullopt;
  return shares_svg(shares, name);
}

}  // namespace roadfix::bench
