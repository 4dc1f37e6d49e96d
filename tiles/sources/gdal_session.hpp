// GDAL as the rest of this module wants it: registered once, quiet, its errors turned into ours.
#pragma once

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <memory>
#include <string>
#include <string_view>

#include "core/geodesy/utm.hpp"
#include "core/units/planar.hpp"

namespace roadfix {

/// Registers the drivers and sets the options that make damaged files an error. Cheap when repeated.
void require_gdal();

/// Lets GDAL's cache of pixels hold so many bytes, as far as they are no more than a quarter of the memory.
void keep_in_cache(double bytes);

/// Collects what GDAL complains about on this thread, while it lives, instead of printing it.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  /// The last failure, or "no reason given".
  std::string text() const;
  static constexpr std::string_view kNone = "no reason given";

 private:
  static void CPL_STDCALL collect(CPLErr severity, CPLErrorNum number, const char* message);
  GdalMessages* outer_;
  std::string last_;
};

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using DatasetPtr = std::unique_ptr<GDALDataset, CloseDataset>;

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};
/// Of VSIFOpenL().
using FilePtr = std::unique_ptr<VSILFILE, CloseFile>;

/// nullptr where GDAL cannot. `flags` and `open_options` are those of GDALOpenEx.
DatasetPtr try_to_open(const std::string& path, unsigned flags, const char* const* open_options = nullptr);

/// Throws NotFound ("file-not-found") or InvalidInput ("source-unreadable") with GDAL's reason.
DatasetPtr open_dataset(const std::string& path, unsigned flags, const char* const* open_options = nullptr);

/// What to do about pixels that cannot be read, by what GDAL says of them.
std::string_view remedy_of_pixels(std::string_view reason);

/// Reference systems with x east or longitude first, whatever their authority says.
OGRSpatialReference utm_reference(UtmZone zone);
OGRSpatialReference wgs84_reference();
/// "EPSG:26986", WKT, PROJ text. Throws InvalidInput "crs-unknown".
OGRSpatialReference parse_crs(const std::string& text);
std::string crs_name(const OGRSpatialReference& reference);
/// Whether it says where on Earth coordinates lie: neither the grid of a site nor what GDAL gives to a GeoPackage that
/// says of a layer that its reference system is not defined.
bool lies_on_earth(const OGRSpatialReference& reference);
/// "" for nullptr, else that the reference system, by its name, does not do that; goes on after "no reference system".
std::string not_on_earth(const OGRSpatialReference* reference);
/// What to do about a wrong reference system. Commands that only look at imagery read it with the same functions as
/// `ingest`, and have no --crs.
inline constexpr std::string_view kGiveRightCrs = "give the right one with --crs of ingest, or write it into the file";

struct DestroyTransformation {
  void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
};
using TransformationPtr = std::unique_ptr<OGRCoordinateTransformation, DestroyTransformation>;
/// Whether it rests on another ellipsoid than that of WGS 84, on which the same place has other coordinates.
bool on_old_ellipsoid(const OGRSpatialReference& reference);
/// Throws InvalidInput "datum-unknown" where the way from one to the other is a guess, which takes places on another
/// ellipsoid than that of WGS 84 for places on it: they lie up to some hundred metres apart. `path` is named in it.
void require_known_datum(const OGRSpatialReference& from, const OGRSpatialReference& to, const std::string& path);
/// Throws InvalidInput ("crs-not-transformable", "datum-unknown"); `path` is named in it.
TransformationPtr transformation(const OGRSpatialReference& from, const OGRSpatialReference& to,
                                 const std::string& path);

}  // namespace roadfix
