// One layer of a vector file as roads: by which attribute its lines are told apart, and which of them are drawn.
#pragma once

#include <ogrsf_frmts.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tiles/roads/line_counts.hpp"
#include "tiles/roads/road_rules.hpp"
#include "tiles/roads/vector_file.hpp"
#include "tiles/sources/coordinate_limits.hpp"
#include "tiles/sources/gdal_session.hpp"

namespace roadfix {

/// The places of a layer's attributes. OGR compares a name with those of all attributes, of which vector tiles have
/// hundreds, and each road is asked for a dozen.
class AttributePlaces {
 public:
  explicit AttributePlaces(OGRLayer& layer) : definition_(layer.GetLayerDefn()) {}

  /// Negative where the layer has no such attribute.
  int operator()(std::string_view name);

 private:
  const OGRFeatureDefn* definition_;
  std::map<std::string, int, std::less<>> known_;
};

/// How a feature is drawn.
struct DrawnFeature {
  double width_m = 0.0;
  std::string road_class;  ///< as it stands in the file; empty where the layer or the feature has none
};

class RoadLayer {
 public:
  /// The class attribute is that of the rules; where the layer, unlike those of OpenStreetMap, lacks it and the user
  /// named none, the first of fclass, type, class and road_class whose values are mostly classes of the rules. The
  /// layer, one of the file's, must outlive this.
  RoadLayer(const VectorFile& file, OGRLayer& layer, TransformationPtr to_plane, const RoadRules& rules);

  std::string name() const { return layer_->GetName(); }
  OGRLayer& layer() const { return *layer_; }
  OGRCoordinateTransformation& to_plane() const { return *to_plane_; }
  /// Whether its features have a class attribute, packed among other tags or not. Without one nothing tells its roads
  /// from its rivers.
  bool classified() const { return classified_; }
  const std::string& class_attribute() const { return rules_.class_attribute(); }
  /// "no attributes" or "the attributes a, b", for messages.
  std::string attributes() const;

  /// Takes note of a feature; nullopt to leave it out.
  std::optional<DrawnFeature> see(const OGRFeature& feature);
  /// Around all lines that tell where the roads were looked for, in the layer's own coordinates: where the layer has
  /// classes those of classes that the rules know, drawn or not, else all. nullopt where there was none.
  std::optional<OGREnvelope> extent_seen() const;

  /// Widths in metres of the drawn features that state them in an attribute of the layer or in the one that the user
  /// named, by the attribute's name in the file.
  const std::map<std::string, std::vector<double>>& stated_widths() const { return stated_widths_; }
  /// Of the lines that were seen. Impossible ones were not looked at further.
  const LineCounts& counts() const { return counts_; }
  /// Areas that would be drawn if they were lines.
  std::int64_t areas() const { return areas_; }

 private:
  void note_stated_width(const OGRFeature& feature, const std::optional<StatedWidth>& stated);

  std::string path_;
  OGRLayer* layer_;
  TransformationPtr to_plane_;
  AttributePlaces places_;
  CoordinateLimits limits_;
  RoadRules rules_;
  bool classified_ = false;
  bool tells_other_lines_;
  OGREnvelope seen_;
  std::map<std::string, std::vector<double>> stated_widths_;
  LineCounts counts_;
  std::int64_t areas_ = 0;
};

}  // namespace roadfix
