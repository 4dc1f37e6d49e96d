#include "tiles/imagery/georeference.hpp"

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_alg.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/detect/frame.hpp"
#include "core/grid/lattice.hpp"
#include "core/units/error.hpp"
#include "tiles/imagery/geotransform.hpp"
#include "tiles/sources/coordinate_limits.hpp"

namespace roadfix {
namespace {

std::string wkt(const OGRSpatialReference& reference) {
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2", nullptr};
  reference.exportToWkt(&text, options);
  std::string result = text != nullptr ? text : "";
  CPLFree(text);
  return result;
}

void require_pixels_with_area(const RasterFile& file) {
  auto to_reference = geotransform_of(file.dataset());
  Geotransform to_pixels{};
  if (!to_reference || GDALInvGeoTransform(to_reference->data(), to_pixels.data()) != FALSE) return;
  throw InvalidInput("image-without-georeference",
                     fmt::format("{}: its geotransform ({}) gives its pixels no area, so that nothing says where they "
                                 "lie; gdal_translate -a_ullr WEST NORTH EAST SOUTH makes a copy with the right one",
                                 file.path(), fmt::join(*to_reference, ", ")));
}

/// Where its geotransform or control points put a raster, and about how wide they make its pixels, in the units of its
/// reference system.
struct StatedPlace {
  OGREnvelope box;
  double pixel = 0.0;
};

StatedPlace place_of(const Geotransform& t, cv::Size size) {
  StatedPlace place;
  for (const int col : {0, size.width}) {
    for (const int row : {0, size.height}) {
      place.box.Merge(t[0] + t[1] * col + t[2] * row, t[3] + t[4] * col + t[5] * row);
    }
  }
  place.pixel = std::sqrt(std::abs(t[1] * t[5] - t[2] * t[4]));
  return place;
}

StatedPlace place_by_points(GDALDataset& dataset) {
  StatedPlace place;
  OGREnvelope pixels;
  for (int i = 0; i < dataset.GetGCPCount(); ++i) {
    const GDAL_GCP& point = dataset.GetGCPs()[i];
    place.box.Merge(point.dfGCPX, point.dfGCPY);
    pixels.Merge(point.dfGCPPixel, point.dfGCPLine);
  }
  const auto diagonal = [](const OGREnvelope& of) { return std::hypot(of.MaxX - of.MinX, of.MaxY - of.MinY); };
  place.pixel = diagonal(place.box) / diagonal(pixels);
  return place;
}

void require_likely_coordinates(const RasterFile& file) {
  const auto transform = geotransform_of(file.dataset());
  if (!transform && file.dataset().GetGCPCount() == 0) return;
  const StatedPlace place = transform ? place_of(*transform, file.size()) : place_by_points(file.dataset());
  // No camera's pixels are as fine in metres as pixels of degrees look there.
  const double side_m = place.pixel * file.crs().GetLinearUnits();
  if (side_m < kFinestGsdM) refuse_degrees_as_metres(place.box, file.crs(), file.path());
  refuse_swapped_axes(place.box, file.crs(), file.path());
}

void transform(void* transformer, std::vector<cv::Point2d>& points, bool to_source) {
  const GdalMessages messages;
  const std::size_t count = points.size();
  std::vector<double> x(count);
  std::vector<double> y(count);
  std::vector<double> z(count, 0.0);
  std::vector<int> good(count, FALSE);
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = points[i].x;
    y[i] = points[i].y;
  }
  GDALGenImgProjTransform(transformer, to_source ? TRUE : FALSE, static_cast<int>(count), x.data(), y.data(), z.data(),
                          good.data());
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < count; ++i) {
    const bool finite = good[i] != FALSE && std::isfinite(x[i]) && std::isfinite(y[i]);
    points[i] = finite ? cv::Point2d(x[i], y[i]) : cv::Point2d(kNowhere, kNowhere);
  }
}

/// GDAL fits a polynomial of second order to six control points or more.
void require_fitting_points(const RasterFile& file) {
  GDALDataset& dataset = file.dataset();
  if (dataset.GetGCPCount() == 0 || geotransform_of(dataset)) return;
  const GdalMessages messages;
  if (PixelTransformerPtr(GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&dataset), nullptr, nullptr))) return;
  throw InvalidInput("image-without-georeference",
                     fmt::format("{}: its {} control points lie so that nothing fits them ({}), as on a line or two, "
                                 "on one another, or along the rim alone: give it others, or make an orthoimage by a "
                                 "simpler fit where they allow one (gdalwarp -order 1)",
                                 file.path(), dataset.GetGCPCount(), messages.text()));
}

/// West, south, east and north of the image in degrees, as GDAL wants them. Left to itself GDAL (3.6) counts the
/// longitudes from the prime meridian of the reference system, finds no way from its datum around there, and leaves the
/// datum as it is. In whole degrees where the ellipsoid is that of WGS 84: GDAL keeps the way that it found within an
/// area, and to find one takes longer than to read a small image. Empty where it cannot be told.
std::string area_of_interest(const RasterFile& file) {
  const GdalMessages messages;
  const PixelTransformerPtr to_reference(
      GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&file.dataset()), nullptr, nullptr));
  if (!to_reference) return "";
  std::vector<cv::Point2d> points;
  for (const double row : {0.0, 0.5, 1.0}) {
    for (const double col : {0.0, 0.5, 1.0}) points.emplace_back(col * file.size().width, row * file.size().height);
  }
  transform(to_reference.get(), points, false);
  const TransformationPtr to_earth = transformation(file.crs(), wgs84_reference(), file.path());
  OGREnvelope area;
  for (const cv::Point2d& point : points) {
    double lon = point.x;
    double lat = point.y;
    if (to_earth->Transform(1, &lon, &lat) == FALSE) return "";
    area.Merge(lon, lat);
  }
  const auto text = [](double west, double south, double east, double north) {
    return fmt::format("{},{},{},{}", west, south, east, north);
  };
  if (on_old_ellipsoid(file.crs())) return text(area.MinX, area.MinY, area.MaxX, area.MaxY);
  if (!(area.MinX >= -180.0 && area.MaxX <= 180.0 && area.MinY >= -90.0 && area.MaxY <= 90.0)) return "";
  return text(std::floor(area.MinX), std::floor(area.MinY), std::ceil(area.MaxX), std::ceil(area.MaxY));
}

PixelTransformerPtr create_transformer(const RasterFile& file, const OGRSpatialReference& target) {
  require_known_datum(file.crs(), target, file.path());
  require_pixels_with_area(file);
  require_likely_coordinates(file);
  const GdalMessages messages;
  CPLStringList options;
  options.SetNameValue("SRC_SRS", wkt(file.crs()).c_str());
  options.SetNameValue("DST_SRS", wkt(target).c_str());
  const std::string area = area_of_interest(file);
  if (!area.empty()) options.SetNameValue("AREA_OF_INTEREST", area.c_str());
  // Of the scene's mean height: hills are misplaced by their share of the view's slant. With a terrain model at hand,
  // gdalwarp -rpc -to RPC_DEM=... makes an orthoimage first.
  const char* height = file.dataset().GetMetadataItem("HEIGHT_OFF", "RPC");
  if (height != nullptr) options.SetNameValue("RPC_HEIGHT", height);
  PixelTransformerPtr transformer(
      GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&file.dataset()), nullptr, options.List()));
  if (!transformer) {
    require_fitting_points(file);
    throw InvalidInput(
        "crs-not-transformable",
        fmt::format("{}: no way from its reference system {} to {} ({}); if it is wrong, {}", file.path(),
                    crs_name(file.crs()), crs_name(target), messages.text(), kGiveRightCrs));
  }
  return transformer;
}

[[noreturn]] void nowhere(const RasterFile& file, const std::string& target) {
  throw InvalidInput("crs-not-transformable",
                     fmt::format("{}: its coordinates in {} have no place in {}; if the reference system is wrong, {}",
                                 file.path(), crs_name(file.crs()), target, kGiveRightCrs));
}

/// Throws where a point of the ground leads back to elsewhere in the raster: what was seen beyond the 180th meridian
/// stands at the other end of the world in its reference system.
void require_way_back(const RasterFile& file, const std::vector<cv::Point2d>& pixels,
                      const std::vector<cv::Point2d>& back) {
  const double far = 0.5 * std::max(file.size().width, file.size().height);  // fits to control points are off by less
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!(cv::norm(back[i] - pixels[i]) > far)) continue;
    throw InvalidInput(
        "raster-beyond-its-reference",
        fmt::format("{}: it goes on beyond the end of {}, and what lies there would be lost. Cut it there "
                    "(gdal_translate -projwin), and move the other half to the other end (gdal_translate -a_ullr)",
                    file.path(), crs_name(file.crs())));
  }
}

/// On a grid over the rectangle, with its corners; `steps` each way.
std::vector<cv::Point2d> points_over(const cv::Rect& pixels, int steps) {
  std::vector<cv::Point2d> points;
  for (int row = 0; row <= steps; ++row) {
    for (int col = 0; col <= steps; ++col) {
      points.emplace_back(pixels.x + static_cast<double>(pixels.width) * col / steps,
                          pixels.y + static_cast<double>(pixels.height) * row / steps);
    }
  }
  return points;
}

/// Around those that have a place; kEmptyBox where none has.
GridBox box_of_known(const std::vector<cv::Point2d>& points) {
  GridBox box = kEmptyBox;
  for (const cv::Point2d& p : points) {
    const GridPoint at{p.x, p.y};
    if (!std::isnan(p.x)) box = united(box, {at, at});
  }
  return box;
}

}  // namespace

void DestroyTransformer::operator()(void* transformer) const { GDALDestroyGenImgProjTransformer(transformer); }

Georeference::Georeference(const RasterFile& file, UtmZone zone)
    : file_(&file), zone_(zone), transformer_(create_transformer(file, utm_reference(zone))) {}

void Georeference::to_pixels(std::vector<cv::Point2d>& points) const { transform(transformer_.get(), points, true); }
void Georeference::to_plane(std::vector<cv::Point2d>& points) const { transform(transformer_.get(), points, false); }

GridBox Georeference::footprint() const {
  const std::vector<cv::Point2d> pixels = points_over({{}, file_->size()}, 32);
  std::vector<cv::Point2d> points = pixels;
  to_plane(points);
  std::vector<cv::Point2d> back = points;
  to_pixels(back);
  require_way_back(*file_, pixels, back);
  const GridBox box = box_of_known(points);
  if (box.empty() || !box.overlaps(kLattice)) nowhere(*file_, fmt::format("UTM zone EPSG:{} of the map", zone_.epsg()));
  return box;
}

std::vector<GridBox> Georeference::boxes_of_parts() const {
  constexpr double kMargin = 1.0 / 64.0;  // of the side: between points an edge may curve outwards
  std::vector<GridBox> boxes;
  for (const cv::Rect& part : file_->parts()) {
    std::vector<cv::Point2d> points = points_over(part, 8);
    to_plane(points);
    const bool whole = std::ranges::none_of(points, [](const cv::Point2d& p) { return std::isnan(p.x); });
    const GridBox box = whole ? box_of_known(points) : footprint();
    boxes.push_back(grown(box, std::max(box.width_m(), box.height_m()) * kMargin));
  }
  return boxes;
}

double Georeference::gsd_m() const {
  const cv::Point2d centre(file_->size().width / 2.0, file_->size().height / 2.0);
  std::vector<cv::Point2d> points{centre, centre + cv::Point2d(1.0, 0.0), centre + cv::Point2d(0.0, 1.0)};
  to_plane(points);
  const cv::Point2d right = points[1] - points[0];
  const cv::Point2d down = points[2] - points[0];
  const double gsd = std::sqrt(std::abs(right.cross(down)));
  if (!(gsd > 0.0)) nowhere(*file_, fmt::format("UTM zone EPSG:{} of the map", zone_.epsg()));
  return gsd;
}

LatLon centre_of(const RasterFile& file) {
  const PixelTransformerPtr transformer = create_transformer(file, wgs84_reference());
  std::vector<cv::Point2d> point{{file.size().width / 2.0, file.size().height / 2.0}};
  transform(transformer.get(), point, false);
  const bool on_earth = std::abs(point[0].x) <= 360.0 && std::abs(point[0].y) <= 90.0;
  if (!on_earth) nowhere(file, "latitude and longitude");
  return {point[0].y, point[0].x};
}

}  // namespace roadfix
