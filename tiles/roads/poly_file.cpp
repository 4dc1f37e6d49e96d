#include "tiles/roads/poly_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "core/units/error.hpp"
#include "core/units/file.hpp"
#include "core/units/text.hpp"

namespace roadfix {
namespace {

struct Section {
  bool hole = false;
  OGRLinearRing ring;
};

/// Line by line. `number` is that of the line, for complaints.
class Sections {
 public:
  explicit Sections(std::string path) : path_(std::move(path)) {}

  void add(const std::string& line, int number) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word)) return;
    if (word == "END") {
      if (open_) close(number);
    } else if (!open_) {
      open_.emplace();
      open_->hole = word.starts_with('!');
    } else {
      add_point(line, number);
    }
  }

  std::vector<Section> take(int lines) {
    if (open_) refuse(lines, "the file is cut off: the last ring does not end with END");
    return std::move(sections_);
  }

 private:
  [[noreturn]] void refuse(int number, const std::string& what) const {
    throw InvalidInput("extent-unreadable", fmt::format("{}: line {}: {}", path_, number, what));
  }

  void add_point(const std::string& line, int number) {
    std::istringstream words(line);
    double lon = 0.0;
    double lat = 0.0;
    constexpr double kMaxLon = 360.0;
    if (!(words >> lon >> lat) || std::abs(lon) > kMaxLon || std::abs(lat) > 90.0) {
      refuse(number, fmt::format("'{}' is no longitude and latitude in degrees", trimmed(line)));
    }
    open_->ring.addPoint(lon, lat);
  }

  void close(int number) {
    constexpr int kFewest = 3;
    if (open_->ring.getNumPoints() < kFewest) refuse(number, "the ring that ends here has less than three points");
    open_->ring.closeRings();
    sections_.push_back(std::move(*open_));
    open_.reset();
  }

  std::string path_;
  std::vector<Section> sections_;
  std::optional<Section> open_;
};

std::vector<Section> sections_of(const std::string& text, const std::string& path) {
  std::istringstream lines(text);
  Sections sections(path);
  int number = 1;
  std::string line;
  std::getline(lines, line);  // the name of the whole
  while (std::getline(lines, line)) sections.add(line, ++number);
  return sections.take(number);
}

}  // namespace

bool is_poly_file(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string()) == ".poly";
}

std::unique_ptr<OGRMultiPolygon> parse_poly(const std::string& text, const std::string& path) {
  std::vector<Section> sections = sections_of(text, path);
  auto polygons = std::make_unique<OGRMultiPolygon>();
  for (Section& section : sections) {
    if (section.hole) continue;
    OGRPolygon polygon;
    polygon.addRing(&section.ring);
    for (Section& other : sections) {
      OGRPoint point;
      other.ring.getPoint(0, &point);
      if (other.hole && section.ring.isPointInRing(&point) != FALSE) polygon.addRing(&other.ring);
    }
    polygons->addGeometry(&polygon);
  }
  return polygons;
}

std::unique_ptr<OGRMultiPolygon> read_poly_file(const std::string& path) {
  return parse_poly(read_named_file(path), path);
}

}  // namespace roadfix
