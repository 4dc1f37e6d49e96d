// Colours of things as a satellite sees them over a dry town in summer, measured by eye on real imagery.
#pragma once

#include "tiles/world/plan.hpp"
#include "tiles/world/random.hpp"

namespace roadfix::world::palette {

inline const Colour kSoil{176, 150, 120};
inline const Colour kRedSoil{168, 127, 98};
inline const Colour kGravel{178, 166, 148};
inline const Colour kConcrete{190, 178, 160};
inline const Colour kDryGrass{146, 134, 98};
inline const Colour kGarden{84, 92, 62};
inline const Colour kLawn{66, 84, 60};
inline const Colour kCrop{100, 107, 76};
inline const Colour kStubble{184, 168, 136};
inline const Colour kAsphalt{146, 137, 127};
inline const Colour kSidewalk{178, 167, 152};
inline const Colour kMarking{205, 200, 190};
inline const Colour kTree{44, 58, 42};
inline const Colour kBareTree{92, 84, 66};
inline const Colour kDust{178, 160, 136};
inline const Colour kRubble{186, 176, 162};

/// `share` of the second colour, the rest of the first.
inline Colour mixed(const Colour& a, const Colour& b, double share) { return a * (1.0 - share) + b * share; }
/// Brightness and tint shifted a little, each on its own.
Colour varied(const Colour& base, double amount, Random& random);
Colour flat_roof(Random& random);
Colour tile_roof(Random& random);
Colour metal_roof(Random& random);
Colour facade(Random& random);
Colour lot(Random& random);
Colour car(Random& random);

}  // namespace roadfix::world::palette
