// One open vector file: its layers that may hold roads, their reference systems and extents.
#pragma once

#include <ogrsf_frmts.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tiles/roads/plane_polygon.hpp"
#include "tiles/roads/road_lines.hpp"
#include "tiles/sources/coordinate_limits.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {

/// Column, row and zoom of a vector tile.
struct VectorTile {
  int zoom = 0;
  int x = 0;
  int y = 0;
};
/// From ".../Z/X/Y.mvt" or "Z-X-Y.mvt" (.pbf alike); nullopt for other names or impossible numbers.
std::optional<VectorTile> vector_tile_of(const std::string& path);

class VectorFile {
 public:
  /// Throws NotFound, InvalidInput ("source-unreadable") or CorruptData ("roads-unreadable").
  VectorFile(const std::string& path, const VectorOptions& options);

  const std::string& path() const { return path_; }
  /// All that have geometries, or the one that the user chose, if the file has it; of OpenStreetMap files the lines.
  const std::vector<OGRLayer*>& layers() const { return layers_; }
  /// Whether it is of OpenStreetMap. Then a layer alone may give none of its features until those of others are read,
  /// and tags without an attribute of their own are packed into one.
  bool is_openstreetmap() const { return osm_; }
  /// Of all layers of the file, "'roads', 'rivers'", for messages.
  std::string layer_names() const;
  /// Throws InvalidInput "roads-without-georeference", "crs-unknown".
  OGRSpatialReference crs_of(OGRLayer& layer) const;
  /// What the file was cut out of the world with, in the layer's own coordinates: a vector tile, the box of an extract
  /// of OpenStreetMap. nullopt for other files, in which an extent only says where features are, or once were.
  std::optional<OGREnvelope> cut_out(OGRLayer& layer) const;
  /// About where its lines are, those that can be on Earth, or its other features where it has none, in the layer's own
  /// coordinates. nullopt for an empty layer. Of a GeoPackage, a layer that may hold both and where the file does not
  /// state it, or wrongly, all features of the layer are read.
  std::optional<OGREnvelope> extent_of(OGRLayer& layer);
  using Visit = std::function<void(OGRLayer&, OGRFeature&)>;
  /// Once through all features of layers(); of OpenStreetMap files, of all. Tells how far it is. Throws CorruptData
  /// "roads-unreadable", IoFailure "temporary-files-refused", or Interrupted "work-stopped".
  void for_each_feature(const Visit& visit);

 private:
  void for_each_feature_of(const std::vector<OGRLayer*>& layers, const Visit& visit);
  void tell(double share) const;
  OGRFeatureUniquePtr read(const std::function<OGRFeature*()>& next) const;
  void refuse_unread(const GdalMessages& messages) const;
  std::optional<OGREnvelope> bounding_box(OGRLayer& layer);
  CoordinateLimits limits_of(OGRLayer& layer) const;
  std::optional<OGRSpatialReference> known_crs_of(OGRLayer& layer) const;

  std::string path_;
  VectorOptions options_;
  std::optional<VectorTile> tile_;
  bool osm_ = false;
  DatasetPtr dataset_;
  std::vector<OGRLayer*> layers_;
};

/// The box as a polygon on the plane, its edges followed closely. Throws InvalidInput "crs-not-transformable".
PlanePolygon box_on_plane(const OGREnvelope& box, OGRCoordinateTransformation& to_plane, const std::string& path);

/// Throws InvalidInput "crs-not-transformable". `remedy` is what to do about a wrong reference system.
[[noreturn]] void refuse_as_nowhere(const std::string& path, std::string_view remedy);

/// Of the box. `remedy` is what to do about a wrong reference system. Throws InvalidInput "crs-not-transformable".
LatLon centre_on_earth(const OGREnvelope& box, const OGRSpatialReference& crs, const std::string& path,
                       std::string_view remedy);

/// The box with each side that is shorter on the plane grown to `side_m` about its middle: that of a single straight
/// road may have no height. A box without a place in the zone stays as it is.
OGREnvelope with_sides_of(const OGREnvelope& box, double side_m, OGRCoordinateTransformation& to_plane);

}  // namespace roadfix
